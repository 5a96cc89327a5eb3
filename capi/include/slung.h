/*
 * slung.h: path following for a multirotor that carries a payload on a cable, from C99 and C++.
 *
 * The payload follows a path in space, at a speed and with a yaw that the path prescribes. A controller is made once of named
 * numbers (the parameters), and then stepped once every control period with the state sampled now and what the pilot wants; it
 * answers with thrust and torque, rotor speeds, and setpoints for an inner loop of body rates.
 *
 *     slung_parameters parameters;
 *     slung_controller controller;
 *     slung_error      error = {sizeof error};
 *     slung_output     output = {sizeof output};
 *
 *     slung_parameters_default(&parameters, sizeof parameters);
 *     slung_parameters_set(&parameters, "VEH_M_LOAD", 0.5f, &error);
 *     slung_create(&controller, sizeof controller, &parameters, &error);
 *     slung_take_over(&controller, &state, &applied);              in flight
 *     slung_step(&controller, &state, SLUNG_FOLLOW, &output);      every period
 *
 * Axes and signs. The world N is north, east, down (n3 points DOWN, altitude is minus the third component); the body B is
 * forward, right, down (FRD); thrust acts along -b3. The payload's position and velocity are the PAYLOAD's. The rod vector
 * points FROM the UAV TO the payload. slung_state_from_payload and slung_state_from_cable make such a state of the numbers of an
 * autopilot or a motion-capture system in their own axes; do not convert by hand, compilers fuse multiplications.
 * Units are SI and stand in the names.
 *
 * Memory. Instances live in the caller's memory, need no destruction, and may be copied with memcpy: they hold no pointers, but
 * for those of a route to its table. The library allocates nothing, has no globals, and uses no libm. A step takes a bounded time
 * and at most 2.2 KiB of stack, a circle's 1.8 KiB; slung_create takes at most 18 KiB. Call the functions of one instance from one
 * context at a time, with the FPU's context saved as for any C function that uses floats.
 *
 * Errors. Every call returns SLUNG_OK or a negative status, and changes nothing when it refuses, with two exceptions: a step with
 * an unknown request is flown, on the last one, and a state that is not to be trusted (SLUNG_BAD_STATE) is written. What is lent to
 * slung_route_build may be written to. slung_step is total: whatever bits the state holds, the output is finite and within the
 * limits, and says why in mode, fault and warning.
 */
#ifndef SLUNG_H
#define SLUNG_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Changes when a call or a structure changes in a way that needs recompiling. Compare with slung_abi_version(). */
#define SLUNG_ABI_VERSION 1u

/* Status: what a call returns, as int32_t. slung_status_text() says it in words. */
enum slung_status {
    SLUNG_OK = 0,
    SLUNG_NULL_POINTER = -1,
    SLUNG_MISALIGNED = -2,
    SLUNG_STRUCT_SIZE = -3,
    SLUNG_TOO_SMALL = -4,
    SLUNG_NOT_CREATED = -5,
    SLUNG_UNKNOWN_PARAMETER = -6,
    SLUNG_OUT_OF_RANGE = -7,
    SLUNG_NOT_WHOLE = -8,
    SLUNG_UNSTABLE_GAINS = -9,
    SLUNG_BAD_STATE = -10,
    SLUNG_UNKNOWN_ENUMERATOR = -11,
    SLUNG_NO_ROUTE = -12,
    SLUNG_LATE = -13,
    SLUNG_OUTLIER = -14,
    SLUNG_NOT_NOW = -15
};

/* What the pilot wants, as uint32_t. */
enum slung_request {
    SLUNG_OFF = 0,    /* rotors off, at once */
    SLUNG_IDLE = 1,   /* armed on the ground; in flight the same as hold */
    SLUNG_FOLLOW = 2, /* join the path, then follow it */
    SLUNG_HOLD = 3,   /* stop where it is */
    SLUNG_LAND = 4    /* sink, and switch off on the ground */
};

/* What the vehicle is doing, as uint32_t. */
enum slung_mode {
    SLUNG_MODE_OFF = 0,
    SLUNG_MODE_IDLE = 1,
    SLUNG_MODE_JOIN = 2,
    SLUNG_MODE_FOLLOW = 3,
    SLUNG_MODE_HOLD = 4,
    SLUNG_MODE_LAND = 5,
    SLUNG_MODE_FAULT = 6,
    SLUNG_MODE_TAKE_OFF = 7
};

/* Which margin is past its warning, as uint32_t. */
enum slung_warning {
    SLUNG_WARNING_NONE = 0,
    SLUNG_WARNING_ROD_ANGLE = 1,
    SLUNG_WARNING_THRUST_ANGLE = 2,
    SLUNG_WARNING_TENSION = 3,
    SLUNG_WARNING_THRUST = 4,
    SLUNG_WARNING_PATH = 5,
    SLUNG_WARNING_REACH = 6,
    SLUNG_WARNING_YAW = 7
};

/* Why the vehicle does not do what was asked, as uint32_t: the last fault since the request changed. */
enum slung_fault {
    SLUNG_FAULT_NONE = 0,
    SLUNG_FAULT_NO_STATE = 1,     /* slung_step was given no state */
    SLUNG_FAULT_NOT_FINITE = 2,   /* the law's answer was not finite */
    SLUNG_FAULT_NO_PATH = 3,      /* no point of the path was found from here */
    SLUNG_FAULT_PAYLOAD_LOST = 4, /* the payload is gone */
    SLUNG_FAULT_SLACK = 5,        /* the cable is slack, or shorter than it was told to be */
    SLUNG_FAULT_CONTRADICTION = 6, /* load and UAV are measured where no cable of this length could have them */
    SLUNG_FAULT_CAUGHT = 7,       /* landing, the UAV hung from its cable: the load is caught */
    SLUNG_FAULT_STATE = 0x100,    /* plus: 0 position, 1 velocity, 2 rod, 3 rod rate, 4 attitude, 5 body rate,
                                     6 position and 7 velocity of the UAV */
    SLUNG_FAULT_MARGIN = 0x200    /* plus an enum slung_warning: that margin is beyond its limit */
};

/* What an estimate of the rod is worth, as uint32_t. */
enum slung_validity {
    SLUNG_VALID = 0,        /* as good as its deviation says */
    SLUNG_CONVERGING = 1,   /* not known to 0.15 rad, or not to 0.04 rad an axis for 3030 periods (6 s at 500 Hz), or to 0.15 rad for
                               twice as many, yet */
    SLUNG_INCONSISTENT = 2, /* thrust and rod have disagreed for some 500 periods, 1 s at 500 Hz: something is not as told */
    SLUNG_BLIND = 3,        /* inputs have been missing for more than 50 periods, 0.1 s at 500 Hz */
    SLUNG_SLACK_CABLE = 4   /* there is no rod */
};

/* Axes of a world and a body, as uint32_t; all right-handed. */
enum slung_frames {
    SLUNG_NED_FRD = 0, /* north, east, down; forward, right, down: PX4, ArduPilot */
    SLUNG_ENU_FLU = 1, /* east, north, up; forward, left, up: ROS */
    SLUNG_NWU_FLU = 2  /* north, west, up; forward, left, up: motion capture, Crazyflie, MuJoCo */
};

/* A parameter set; slung_parameters_default makes it. */
typedef struct slung_parameters {
    uint64_t storage[128];
} slung_parameters;

/* A controller; slung_create makes it. */
typedef struct slung_controller {
    uint64_t storage[512];
} slung_controller;

/* A route; slung_route_build makes it. It points to the knots and runs that it was given. */
typedef struct slung_route {
    uint64_t storage[8];
} slung_route;

/* An estimator of the load's state; slung_estimator_create makes it. */
typedef struct slung_estimator {
    uint64_t storage[256];
} slung_estimator;

/* A navigation filter; slung_navigation_create makes it. */
typedef struct slung_navigation {
    uint64_t storage[320];
} slung_navigation;

/* Room for a control point of a route, and for the part of one between two stops. */
typedef struct slung_knot {
    float numbers[15];
} slung_knot;
typedef struct slung_run {
    size_t words[2];
    uint32_t more[2];
} slung_run;

/* A point of a route, with how it is flown from there on. */
typedef struct slung_waypoint {
    float point_ned_m[3];
    float corner_m;  /* where a corner's blend begins and ends, 0.02 to 1000; 0: the curve passes smoothly through the point */
    float speed_m_s; /* of the leg that begins here, 0.05 to 100 */
    float yaw_rad;   /* not a number: along the route */
    float stop_s;    /* how long the payload rests here, INFINITY: until slung_go_on; negative: it passes */
} slung_waypoint;

/* How a route is sped up and slowed down. */
typedef struct slung_pace {
    float acceleration_m_s2; /* along the route and across it, 0.05 to 20 */
    float stop_rate_1_s;     /* speed over distance near a stop, 0.05 to 5 */
    float rise_s;            /* in which the acceleration may rise, 0.05 to 10 */
} slung_pace;

/* Where things sit on the UAV, from its centre of mass, and drag: of speed (N.s/m) and of its square (N.s2/m2). */
typedef struct slung_mounting {
    float hook_frd_m[3];
    float imu_frd_m[3];
    float uav_drag[2];
    float payload_drag[2];
} slung_mounting;

/* What a navigation filter is told. Set struct_size to sizeof(slung_navigation_settings), then slung_navigation_defaults fills it in:
 * a MEMS IMU in flight and an RTK receiver. Standard deviations, and square roots of spectral densities (rthz: per square root of
 * Hz; rts: per square root of s). */
typedef struct slung_navigation_settings {
    uint32_t struct_size;
    float imu_frd_m[3];                /* where the IMU sits, from the UAV's centre of mass, each within 2 */
    float antenna_frd_m[3];            /* where the antenna sits, likewise */
    float declination_rad;             /* where a level compass points, from north toward east */
    float accelerometer_m_s2_rthz;     /* noise IN FLIGHT, 1e-4 to 1 */
    float gyro_rad_s_rthz;             /* noise in flight, 1e-6 to 0.1 */
    float accelerometer_walk_m_s2_rts; /* walk of its bias, 1e-7 to 0.1 */
    float gyro_walk_rad_s_rts;         /* likewise, 1e-8 to 0.01 */
    float fix_position_m[2];           /* least error of a receiver's fix that is believed, horizontal and vertical, 1e-3 to 100 */
    float fix_velocity_m_s[2];         /* likewise, 1e-3 to 10 */
    float heading_rad;                 /* of a heading or magnetic field, its slow error with it, 1e-3 to 3 */
    float barometer_m;                 /* likewise, 0.01 to 100 */
    float barometer_time_s;            /* over which the barometer's offset follows the fixes, 1 to 1e4 */
    float start_position_m;            /* how well the start is known: position, 1e-3 to 1e5 */
    float start_velocity_m_s;          /* 1e-3 to 1000 */
    float start_tilt_rad;              /* 1e-3 to 3 */
    float start_heading_rad;           /* 1e-3 to 3 */
    float start_gyro_rad_s;            /* bias of the gyro, 1e-5 to 1 */
    float start_accelerometer_m_s2;    /* bias of the accelerometer, 1e-4 to 10 */
} slung_navigation_settings;

/* A fix: of the antenna where a receiver gives it, of the centre of mass where motion capture does. A vector of three times not a number
 * is not measured. */
typedef struct slung_fix {
    float position_world_m[3];
    float velocity_world_m_s[3];
    float position_deviation_m[2];   /* as the source states it, horizontal and vertical */
    float velocity_deviation_m_s[2]; /* likewise */
    float age_s;                     /* how old it is when it comes: 0 to 150 periods, 0.3 s at 500 Hz */
} slung_fix;

/* Why a call was refused. Set struct_size to sizeof(slung_error) before the call. */
typedef struct slung_error {
    uint32_t struct_size;
    int32_t status; /* enum slung_status */
    char field[32]; /* the parameter's or field's name */
    float value;    /* what it was given */
    float min;      /* the least that it takes */
    float max;      /* the largest */
    int32_t waypoint; /* of a route, from 0; negative: it is about none */
} slung_error;

/* An entry of the table of parameters. Set struct_size to sizeof(slung_parameter) before the call. */
typedef struct slung_parameter {
    uint32_t struct_size;
    float default_value;
    float min;
    float max;
    char name[20];
    char unit[20];
    char text[160];
} slung_parameter;

/* The UAV as its navigation reports it, in the axes of an enum slung_frames. */
typedef struct slung_uav {
    float position_world_m[3];         /* of the centre of mass */
    float velocity_world_m_s[3];       /* likewise */
    float quaternion_body_to_world[4]; /* w, x, y, z; of unit length */
    float body_rate_rad_s[3];
} slung_uav;

/* What a navigation filter has found. Set struct_size to sizeof(slung_navigated) before the call. */
typedef struct slung_navigated {
    uint32_t struct_size;
    uint32_t blind;  /* 1 while the IMU has been silent for more than 50 periods, 0.1 s at 500 Hz */
    uint32_t resets; /* how often the filter has started anew from a fix: uav has jumped when this changes */
    float fix_age_s; /* since the last fix that was taken */
    float position_deviation_m; /* standard deviation, horizontal, both axes together */
    float velocity_deviation_m_s;
    float tilt_deviation_rad;
    float gyro_bias_body_rad_s[3];
    float accelerometer_bias_body_m_s2[3];
    float specific_force_body_m_s2[3]; /* less its bias: for slung_estimator_step, with uav, and slung_step_measured */
    slung_uav uav;                     /* for slung_estimator_step */
} slung_navigated;

/* The state that the law is stepped on. */
typedef struct slung_state {
    float payload_position_ned_m[3];
    float payload_velocity_ned_m_s[3];
    float rod_ned[3];             /* unit vector from the UAV's centre of mass to the payload */
    float rod_rate_ned_1_s[3];    /* its derivative, orthogonal to it */
    float attitude_frd_to_ned[9]; /* row by row; its columns are b1, b2, b3 in N */
    float body_rate_frd_rad_s[3];
} slung_state;

/* What an estimator has found. Set struct_size to sizeof(slung_estimate) before the call.
 * The state goes into a step while validity is SLUNG_VALID, and NULL goes there otherwise: on a slack cable there is no rod, and
 * hold and landing fly the UAV alone. Beside the state goes this UAV, not navigation's: where navigation jumps by 5 cm to 2 m, both
 * glide to the new place within some seconds, while the UAV by navigation is there at once, where no cable reaches from it to the
 * load. */
typedef struct slung_estimate {
    uint32_t struct_size;
    uint32_t validity; /* enum slung_validity */
    uint32_t taut;     /* 1 while the cable pulls */
    float tension_n;
    float rod_deviation_rad; /* standard deviation of the rod's direction, both axes together */
    float rate_deviation_1_s;
    slung_state state; /* for slung_step_measured, or slung_step */
    slung_uav uav;     /* likewise: the UAV of this step, in its axes; not a number where it was NULL, and a step takes that for NULL */
} slung_estimate;

/* Thrust along -b3, and torque. */
typedef struct slung_wrench {
    float thrust_n;
    float torque_frd_n_m[3];
} slung_wrench;

/* A step's answer. Set struct_size to sizeof(slung_output) before the call. */
typedef struct slung_output {
    uint32_t struct_size;
    uint32_t mode;    /* enum slung_mode */
    uint32_t fault;   /* enum slung_fault */
    uint32_t warning; /* enum slung_warning */
    uint32_t limited; /* 1 if limits or rotors give less than the law asked for */
    float thrust_n;   /* for the coming period, after limits and rotors */
    float torque_frd_n_m[3];
    float angular_acceleration_frd_rad_s2[3]; /* what the torque gives, with what was found to disturb */
    float body_rate_setpoint_frd_rad_s[3];    /* omega + T_i * angular acceleration, T_i = INN_T_i */
    float thrust_normalized;                  /* share of all rotors' largest force (ROT_*) */
    float torque_normalized_frd[3];           /* shares of what all rotors could give about each axis: PX4's convention for an X */
    float rotor[4];                           /* speeds as shares of the largest: front right, rear left, front left, rear right */
} slung_output;

/* How far a route is flown. Set struct_size to sizeof(slung_progress) before the call. */
typedef struct slung_progress {
    uint32_t struct_size;
    uint32_t run;           /* from stop to stop, counted from 0 */
    uint32_t runs;          /* how many there are */
    uint32_t rests;         /* 1 while the payload rests at a stop */
    uint32_t is_over;       /* 1 once it has rested at the last stop for as long as it is to */
    float speed_factor;     /* what the prescribed speed is multiplied by now */
    float nearest_ned_m[3]; /* the route's point nearest to the payload */
} slung_progress;

/* Where a command came from. Set struct_size to sizeof(slung_telemetry) before the call. */
typedef struct slung_telemetry {
    uint32_t struct_size;
    uint32_t law_flew;             /* 1 if the law flew; if not, the numbers up to the margins are zero, but for zeta */
    float xi[20];                  /* h1 .. h1^(5), h2 .. h2^(5), h3 .. h3^(4), h4, h4^(1); then zeros */
    float nu[4];                   /* wanted highest derivatives of the outputs */
    float u_zeta_m_s6;             /* the compensator's input */
    float zeta[4];                 /* the compensator's state when the next command begins to act */
    float margin_rod;              /* q.e3: 1 hanging straight down */
    float margin_thrust_axis;      /* q.b3 */
    float margin_lambda_m_s2;      /* specific force along the rod; -g hanging at rest */
    float margin_kappa_1_s2;       /* thrust over UAV mass and rod length */
    float margin_path;             /* the determinant of the path's 3x3 system */
    float margin_reach;            /* what is left of the reach of a path with a nearest point; 1 for others */
    float payload_force_ned_n[3];  /* found beyond the model's; along the rod that on both bodies */
    float uav_force_ned_n[3];      /* found, across the rod */
    float torque_frd_n_m[3];       /* found */
    float implied_payload_mass_kg; /* that would explain the force along the rod in still air */
} slung_telemetry;

/* The library's version of this interface. */
uint32_t slung_abi_version(void);
/* Bytes that an instance really takes, at most the size of its structure here. */
size_t slung_parameters_bytes(void);
size_t slung_controller_bytes(void);

/* All parameters at their defaults: a vehicle of 2.5 kg with 0.5 kg on 2 m, on a circle of 5 m at 1 m/s.
 * bytes is sizeof(slung_parameters). */
int32_t slung_parameters_default(slung_parameters *parameters, size_t bytes);
/* How many parameters there are, and what each is: index from 0. */
uint32_t slung_parameter_count(void);
int32_t slung_parameter_info(uint32_t index, slung_parameter *info);
/* Sets or reads one by its name. error may be NULL. */
int32_t slung_parameters_set(slung_parameters *parameters, const char *name, float value, slung_error *error);
int32_t slung_parameters_get(const slung_parameters *parameters, const char *name, float *value);

/* Makes a controller, rotors off. bytes is sizeof(slung_controller); error may be NULL. */
int32_t slung_create(slung_controller *controller, size_t bytes, const slung_parameters *parameters, slung_error *error);
/* The same on a route, or on the parameters' own path where it is NULL. The route's knots and runs must stay where they are as
 * long as the controller is used; the route itself need not. */
int32_t slung_create_on(slung_controller *controller, size_t bytes, const slung_parameters *parameters, const slung_route *route,
                        slung_error *error);
/* Takes over a flying vehicle to which applied has been applied until now, without a bump: mode hold. */
int32_t slung_take_over(slung_controller *controller, const slung_state *state, const slung_wrench *applied);
/* Starts on the path from a stated zeta (0 is hover): mode follow, without an approach. */
int32_t slung_start(slung_controller *controller, const slung_state *state, const float zeta[4]);
/* One control period (CTL_PERIOD). state may be NULL: no state this period. request is an enum slung_request; an unknown one is
 * refused, but the period is flown on the last one, and the output is written. Whatever else is refused, nothing is flown. */
int32_t slung_step(slung_controller *controller, const slung_state *state, uint32_t request, slung_output *output);
/* The same with what the UAV's own navigation knows, in the axes of frames, and its accelerometer's specific force in its body axes;
 * any of them may be NULL. Hold and landing then fly the UAV whatever the cable does, and from idle a vehicle takes off. */
int32_t slung_step_measured(slung_controller *controller, const slung_state *state, uint32_t frames, const slung_uav *uav,
                            const float specific_force_body_m_s2[3], uint32_t request, slung_output *output);
/* Turns the output's body vectors from forward-right-down into the body axes of frames, in place. */
int32_t slung_output_in(uint32_t frames, slung_output *output);
/* Where the last step's command came from; state is the one it was made on. */
int32_t slung_telemetry_of(slung_controller *controller, const slung_state *state, slung_telemetry *telemetry);

/* The state of a UAV and its payload, both in the world of frames. SLUNG_BAD_STATE: written, but not to be trusted. */
int32_t slung_state_from_payload(uint32_t frames, const slung_uav *uav, const float payload_position_world_m[3],
                                 const float payload_velocity_world_m_s[3], slung_state *state);
/* The state of a UAV with a taut cable: its hook in body axes from the centre of mass, its length, its direction from hook to
 * payload (a unit vector in the world), and that direction's rate. */
int32_t slung_state_from_cable(uint32_t frames, const slung_uav *uav, const float hook_body_m[3], float cable_length_m,
                               const float cable_world[3], const float cable_rate_world_1_s[3], slung_state *state);

/* Makes the route through waypoints: open, from rest to rest, or closed. bytes is sizeof(slung_route). pace may be NULL: 1 m/s2,
 * 0.5/s, 0.4 s. knots and runs are lent for as long as the route flies: some 10 knots for each waypoint with a corner or stop and one
 * for each smooth one, 20 more for each run, and as many again as there are waypoints, which are read into them; a run for each stop,
 * and one. error (which may be NULL) names the number that is out of its range; with SLUNG_NO_ROUTE its value is the waypoint, from
 * 0, whose leg is shorter than 5 cm ("leg") or where the route turns by more than 150 degrees without a stop ("turn"); with
 * SLUNG_TOO_SMALL it is knot_count or run_count. */
int32_t slung_route_build(slung_route *route, size_t bytes, const slung_waypoint *waypoints, uint32_t waypoint_count,
                          uint32_t closed, const slung_pace *pace, slung_knot *knots, uint32_t knot_count, slung_run *runs,
                          uint32_t run_count, slung_error *error);
/* At the last stop: the way back and forth again (back = 1), or the first run again (0), so many times; 0 times is to stay. */
int32_t slung_route_repeat(slung_route *route, uint32_t times, uint32_t back);
/* Lands where the route ends (1), or hovers there (0): SLUNG_FOLLOW then lands once the payload has rested at the last stop. Before
 * slung_create_on. */
int32_t slung_route_land(slung_route *route, uint32_t lands);
size_t slung_route_bytes(void);
/* Flies the path at factor times its speed from now on, smoothly: 1 as prescribed, 0 rests where it is, less goes back; -2 to 2. */
int32_t slung_set_speed_factor(slung_controller *controller, float factor);
/* Goes on from the stop where the payload rests, before its time is over or where it waits for this (stop_s = INFINITY). SLUNG_NOT_NOW:
 * it does not rest at a stop, or nothing comes after. */
int32_t slung_go_on(slung_controller *controller);
/* How far the controller's route is flown. SLUNG_NOT_NOW: it flies none. */
int32_t slung_progress_of(slung_controller *controller, slung_progress *progress);

/* Makes an estimator of the parameters' vehicle, stepped at their CTL_PERIOD (1 to 10 ms). mounting may be NULL: hook and
 * accelerometer at the centre of mass, no drag. */
int32_t slung_estimator_create(slung_estimator *estimator, size_t bytes, const slung_parameters *parameters,
                               const slung_mounting *mounting, slung_error *error);
/* One period: the UAV at its end by its own navigation, the mean specific force in it less its bias (-g along the body's down axis at
 * rest), and the mean thrust, not a number where it is not known. uav or specific force may be NULL: none this period. */
int32_t slung_estimator_step(slung_estimator *estimator, uint32_t frames, const slung_uav *uav,
                             const float specific_force_body_m_s2[3], float thrust_n, slung_estimate *estimate);
/* The load as somebody saw it, with the deviation per axis and its age: not needed, but it helps. SLUNG_OUT_OF_RANGE: not used. */
int32_t slung_estimator_observe(slung_estimator *estimator, uint32_t frames, const float payload_position_world_m[3],
                                float deviation_m, float age_s);
/* Load and UAV (its centre of mass) as motion capture saw both at one instant, with the deviation per axis of each: better than the load
 * alone, since what navigation makes of the UAV's place shares the accelerometer's noise with the rod. SLUNG_OUT_OF_RANGE: not used. */
int32_t slung_estimator_observe_pair(slung_estimator *estimator, uint32_t frames, const float payload_position_world_m[3],
                                     const float uav_position_world_m[3], float deviation_m, float age_s);
size_t slung_estimator_bytes(void);

/* The UAV's own motion from an IMU and what tells where it is, for who has no autopilot's navigation. Link with --gc-sections: who does not
 * call these does not carry them. In a period: what has come, then the step, whose answer goes to the estimator and the controller:
 *
 *     slung_navigation_fix(&navigation, frames, &fix);            when one has come; so with the others
 *     slung_navigation_step(&navigation, frames, body_rate, specific_force, &navigated);
 *     slung_estimator_step(&estimator, frames, &navigated.uav, navigated.specific_force_body_m_s2, thrust_n, &estimate);
 *     slung_step_measured(&controller, estimate.validity == SLUNG_VALID ? &estimate.state : NULL, frames, &estimate.uav,
 *                         navigated.specific_force_body_m_s2, request, &output);
 *
 * Measurements that are refused leave the filter as it was: SLUNG_OUT_OF_RANGE where a number can't be, SLUNG_LATE where one is older
 * than the filter remembers or from the future, SLUNG_OUTLIER where a position is more than ten deviations off. Fifteen outliers in
 * a row, and the filter starts anew from the last: resets tells. */
int32_t slung_navigation_defaults(slung_navigation_settings *settings);
/* A UAV that stands still at the origin: down is where the mean specific force is not, forward has this heading (from north toward east).
 * Write its position into it, and it is a start. SLUNG_OUT_OF_RANGE: the force says nothing, or the heading is not a number. */
int32_t slung_navigation_at_rest(uint32_t frames, const float specific_force_body_m_s2[3], float heading_rad, slung_uav *uav);
/* Makes a filter that is stepped at the parameters' CTL_PERIOD (1 to 10 ms) and begins at start. bytes is sizeof(slung_navigation);
 * settings may be NULL: the defaults; error may be NULL. SLUNG_BAD_STATE: the start is no state. */
int32_t slung_navigation_create(slung_navigation *navigation, size_t bytes, const slung_parameters *parameters,
                                const slung_navigation_settings *settings, uint32_t frames, const slung_uav *start,
                                slung_error *error);
/* A fix of a satellite receiver. */
int32_t slung_navigation_fix(slung_navigation *navigation, uint32_t frames, const slung_fix *fix);
/* A pose by motion capture: a fix of the centre of mass, and the attitude (w, x, y, z; may be NULL) with its standard deviation. */
int32_t slung_navigation_pose(slung_navigation *navigation, uint32_t frames, const slung_fix *fix,
                              const float quaternion_body_to_world[4], float attitude_deviation_rad);
/* Height above the origin by pressure: POSITIVE UP, whatever the axes. */
int32_t slung_navigation_height(slung_navigation *navigation, float height_up_m);
/* Heading of the UAV's forward axis, from north toward east, whatever the axes. */
int32_t slung_navigation_heading(slung_navigation *navigation, float heading_rad);
/* The magnetic field in the body axes of frames, of any unit. */
int32_t slung_navigation_magnetic_field(slung_navigation *navigation, uint32_t frames, const float field_body[3]);
/* One period, which ends with the IMU's reading: the newest body rate, and the mean specific force (-g along the body's down axis at
 * rest). Either may be NULL: none this period, and the last goes on. */
int32_t slung_navigation_step(slung_navigation *navigation, uint32_t frames, const float body_rate_rad_s[3],
                              const float specific_force_body_m_s2[3], slung_navigated *navigated);
size_t slung_navigation_bytes(void);

/* Texts; never NULL. */
const char *slung_status_text(int32_t status);
const char *slung_mode_text(uint32_t mode);
const char *slung_fault_text(uint32_t fault);
const char *slung_warning_text(uint32_t warning);

#ifdef __cplusplus
}
#endif

#endif
