/* Prints the size of every structure of slung.h and the offset of every field, for comparison with the library's own. */
#include "slung.h"

#include <stdio.h>

#define SIZE(type) printf(#type " %u\n", (unsigned)sizeof(type))
#define FIELD(type, field) printf(#type "." #field " %u\n", (unsigned)offsetof(type, field))

int main(void) {
    SIZE(slung_parameters);
    SIZE(slung_controller);
    SIZE(slung_route);
    SIZE(slung_estimator);
    SIZE(slung_knot);
    SIZE(slung_run);
    SIZE(slung_error);
    FIELD(slung_error, struct_size);
    FIELD(slung_error, status);
    FIELD(slung_error, field);
    FIELD(slung_error, value);
    FIELD(slung_error, min);
    FIELD(slung_error, max);
    SIZE(slung_parameter);
    FIELD(slung_parameter, struct_size);
    FIELD(slung_parameter, default_value);
    FIELD(slung_parameter, min);
    FIELD(slung_parameter, max);
    FIELD(slung_parameter, name);
    FIELD(slung_parameter, unit);
    FIELD(slung_parameter, text);
    SIZE(slung_uav);
    FIELD(slung_uav, position_world_m);
    FIELD(slung_uav, velocity_world_m_s);
    FIELD(slung_uav, quaternion_body_to_world);
    FIELD(slung_uav, body_rate_rad_s);
    SIZE(slung_state);
    FIELD(slung_state, payload_position_ned_m);
    FIELD(slung_state, payload_velocity_ned_m_s);
    FIELD(slung_state, rod_ned);
    FIELD(slung_state, rod_rate_ned_1_s);
    FIELD(slung_state, attitude_frd_to_ned);
    FIELD(slung_state, body_rate_frd_rad_s);
    SIZE(slung_wrench);
    FIELD(slung_wrench, thrust_n);
    FIELD(slung_wrench, torque_frd_n_m);
    SIZE(slung_output);
    FIELD(slung_output, struct_size);
    FIELD(slung_output, mode);
    FIELD(slung_output, fault);
    FIELD(slung_output, warning);
    FIELD(slung_output, limited);
    FIELD(slung_output, thrust_n);
    FIELD(slung_output, torque_frd_n_m);
    FIELD(slung_output, angular_acceleration_frd_rad_s2);
    FIELD(slung_output, body_rate_setpoint_frd_rad_s);
    FIELD(slung_output, thrust_normalized);
    FIELD(slung_output, torque_normalized_frd);
    FIELD(slung_output, rotor);
    SIZE(slung_telemetry);
    FIELD(slung_telemetry, struct_size);
    FIELD(slung_telemetry, law_flew);
    FIELD(slung_telemetry, xi);
    FIELD(slung_telemetry, nu);
    FIELD(slung_telemetry, u_zeta_m_s6);
    FIELD(slung_telemetry, zeta);
    FIELD(slung_telemetry, margin_rod);
    FIELD(slung_telemetry, margin_thrust_axis);
    FIELD(slung_telemetry, margin_lambda_m_s2);
    FIELD(slung_telemetry, margin_kappa_1_s2);
    FIELD(slung_telemetry, margin_path);
    FIELD(slung_telemetry, margin_reach);
    FIELD(slung_telemetry, payload_force_ned_n);
    FIELD(slung_telemetry, uav_force_ned_n);
    FIELD(slung_telemetry, torque_frd_n_m);
    FIELD(slung_telemetry, implied_payload_mass_kg);
    SIZE(slung_waypoint);
    FIELD(slung_waypoint, point_ned_m);
    FIELD(slung_waypoint, corner_m);
    FIELD(slung_waypoint, speed_m_s);
    FIELD(slung_waypoint, yaw_rad);
    FIELD(slung_waypoint, stop_s);
    SIZE(slung_pace);
    FIELD(slung_pace, acceleration_m_s2);
    FIELD(slung_pace, stop_rate_1_s);
    FIELD(slung_pace, rise_s);
    SIZE(slung_mounting);
    FIELD(slung_mounting, hook_frd_m);
    FIELD(slung_mounting, imu_frd_m);
    FIELD(slung_mounting, uav_drag);
    FIELD(slung_mounting, payload_drag);
    SIZE(slung_estimate);
    FIELD(slung_estimate, struct_size);
    FIELD(slung_estimate, validity);
    FIELD(slung_estimate, taut);
    FIELD(slung_estimate, tension_n);
    FIELD(slung_estimate, rod_deviation_rad);
    FIELD(slung_estimate, rate_deviation_1_s);
    FIELD(slung_estimate, state);
    return 0;
}
