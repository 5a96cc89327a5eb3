/* Flies every kind of path and law, a route, the estimator and navigation for 500 steps each and prints a digest of each byte that comes out: on a host and on a target
 * the same. States are whole numbers times powers of two, so that no compiler's way with floats enters them. */
#include "slung.h"

#include "print.h"

static uint32_t random_state;

/* -1 to 1 in steps of 2^-15. */
static float about_zero(void) {
    random_state = random_state * 1664525u + 1013904223u;
    return (float)((int32_t)(random_state >> 16) - 32768) * (1.0f / 32768.0f);
}

static uint64_t digest;

static void take(const void *bytes, size_t count) {
    const unsigned char *byte = (const unsigned char *)bytes;
    for (size_t i = 0; i < count; ++i) digest = (digest ^ byte[i]) * 1099511628211u;
}

/* Some 0.25 m and 0.25 m/s about a place, upright but for a small turn about b3 by powers of two. */
static void about(slung_uav *uav, float payload[3], float velocity[3]) {
    static const float place[3] = {5.0f, 0.0f, -10.0f};
    for (int i = 0; i < 3; ++i) {
        payload[i] = place[i] + 0.25f * about_zero();
        velocity[i] = 0.25f * about_zero();
        uav->position_world_m[i] = payload[i] + (i == 2 ? -2.0f : 0.125f * about_zero());
        uav->velocity_world_m_s[i] = velocity[i] + 0.0625f * about_zero();
        uav->body_rate_rad_s[i] = 0.125f * about_zero();
    }
    uav->quaternion_body_to_world[0] = 1.0f;
    for (int i = 1; i < 4; ++i) uav->quaternion_body_to_world[i] = about_zero() * (1.0f / 64.0f);
}

/* What the header promises, bytes. */
enum { STEP_STACK = 2252, CREATE_STACK = 18432 };

/* A square with a rounded corner, a smooth point and a stop. */
static int build(slung_route *route) {
    static slung_knot knots[160];
    static slung_run runs[4];
    const slung_waypoint points[] = {{{5, 0, -10}, 2, 1, 0, -1}, {{5, 8, -10}, 2, 1.5f, 0, -1}, {{-3, 8, -11}, 2, 1, print_nan(), 1}, {{-3, 0, -10}, 2, 1, 0, -1}};
    stack_paint();
    const int32_t status = slung_route_build(route, sizeof *route, points, 4, 0, NULL, knots, 160, runs, 4, NULL);
    return status == SLUNG_OK && stack_used() <= CREATE_STACK;
}

static int fly(const char *name, const char *const names[], const float values[], int count) {
    static slung_parameters parameters;
    static slung_controller controller;
    static slung_route route;
    slung_uav uav;
    slung_state state;
    float payload[3], velocity[3];
    const float zeta[4] = {0, 0, 0, 0};
    slung_wrench hover = {29.43f, {0, 0, 0}};
    random_state = 1;
    digest = 14695981039346656037u;
    slung_parameters_default(&parameters, sizeof parameters);
    for (int i = 0; i < count; ++i)
        if (slung_parameters_set(&parameters, names[i], values[i], NULL) != SLUNG_OK) return print_failure(name, names[i]);
    const int is_route = name[0] == 'r';
    if (is_route && !build(&route)) return print_failure(name, "route");
    stack_paint();
    if (slung_create_on(&controller, sizeof controller, &parameters, is_route ? &route : NULL, NULL) != SLUNG_OK)
        return print_failure(name, "create");
    if (stack_used() > CREATE_STACK) return print_failure(name, "stack of create");
    unsigned stack = 0;
    for (int step = 0; step < 500; ++step) {
        slung_output output = {0};
        slung_telemetry telemetry = {0};
        output.struct_size = sizeof output;
        telemetry.struct_size = sizeof telemetry;
        about(&uav, payload, velocity);
        slung_state_from_payload(SLUNG_NED_FRD, &uav, payload, velocity, &state);
        if (step == 0) slung_take_over(&controller, &state, &hover);
        if (step == 200) slung_start(&controller, &state, zeta);
        /* Every 50th step has no state, and every 71st one that is not a number. */
        if (step % 71 == 70) state.rod_ned[0] = print_nan();
        stack_paint();
        slung_step_measured(&controller, step % 50 == 49 ? NULL : &state, SLUNG_NED_FRD, step % 3 ? &uav : NULL, NULL,
                            step < 450 ? SLUNG_FOLLOW : SLUNG_LAND, &output);
        if (stack_used() > stack) stack = stack_used();
        slung_telemetry_of(&controller, &state, &telemetry);
        take(&output, sizeof output);
        take(&telemetry, sizeof telemetry);
    }
    print_digest(name, digest);
    print_stack(name, stack);
    return stack > STEP_STACK ? print_failure(name, "stack of a step") : 0;
}

static int estimate(void) {
    static slung_parameters parameters;
    static slung_estimator estimator;
    const slung_mounting mounting = {{0, 0, 0.125f}, {0.0625f, 0, 0}, {0.25f, 0}, {0, 0.0078125f}};
    unsigned stack = 0;
    slung_uav uav;
    float payload[3], velocity[3];
    random_state = 1;
    digest = 14695981039346656037u;
    slung_parameters_default(&parameters, sizeof parameters);
    if (slung_estimator_create(&estimator, sizeof estimator, &parameters, &mounting, NULL) != SLUNG_OK)
        return print_failure("estimator", "create");
    for (int step = 0; step < 500; ++step) {
        slung_estimate found = {0};
        float force[3] = {about_zero(), about_zero(), -9.8125f + about_zero()};
        found.struct_size = sizeof found;
        about(&uav, payload, velocity);
        if (step % 7 == 6) slung_estimator_observe(&estimator, SLUNG_NED_FRD, payload, 0.125f, 0);
        if (step % 11 == 10)
            slung_estimator_observe_pair(&estimator, SLUNG_NED_FRD, payload, uav.position_world_m, 0.125f, 0.0078125f);
        stack_paint();
        slung_estimator_step(&estimator, SLUNG_NED_FRD, step % 50 == 49 ? NULL : &uav, force, 29.5f + about_zero(), &found);
        if (stack_used() > stack) stack = stack_used();
        take(&found, sizeof found);
    }
    print_digest("estimator", digest);
    return stack > STEP_STACK ? print_failure("estimator", "stack of a step") : 0;
}

/* Every measurement in turn, late and wrong ones too, in axes that are not the library's. */
static int navigate(void) {
    static slung_parameters parameters;
    static slung_navigation navigation;
    slung_navigation_settings settings = {0};
    const float rest[3] = {0, 0, 9.8125f}, nothing = print_nan();
    const float level[4] = {1, 0, 0, 0};
    unsigned stack = 0;
    slung_uav start;
    random_state = 1;
    digest = 14695981039346656037u;
    slung_parameters_default(&parameters, sizeof parameters);
    settings.struct_size = sizeof settings;
    slung_navigation_defaults(&settings);
    settings.imu_frd_m[0] = 0.0625f;
    settings.antenna_frd_m[2] = -0.125f;
    settings.declination_rad = 0.0625f;
    if (slung_navigation_at_rest(SLUNG_ENU_FLU, rest, 0.5f, &start) != SLUNG_OK) return print_failure("navigation", "at rest");
    take(&start, sizeof start);
    if (slung_navigation_create(&navigation, sizeof navigation, &parameters, &settings, SLUNG_ENU_FLU, &start, NULL) != SLUNG_OK)
        return print_failure("navigation", "create");
    for (int step = 0; step < 500; ++step) {
        slung_navigated found = {0};
        slung_fix fix = {{0}, {0}, {0.03125f, 0.0625f}, {0.0625f, 0.125f}, 0.125f};
        float rate[3], force[3], field[3] = {0.25f, 0.125f, -0.5f};
        int32_t status[5] = {0};
        found.struct_size = sizeof found;
        for (int i = 0; i < 3; ++i) {
            rate[i] = 0.125f * about_zero();
            force[i] = rest[i] + about_zero();
            fix.position_world_m[i] = 0.0625f * about_zero() + (step % 100 >= 80 ? 64.0f : 0.0f);
            fix.velocity_world_m_s[i] = step % 3 ? 0.0625f * about_zero() : nothing;
        }
        if (step % 71 == 70) fix.age_s = 2;
        if (step % 67 == 66) force[1] = nothing;
        stack_paint();
        if (step % 10 == 0) status[0] = slung_navigation_fix(&navigation, SLUNG_ENU_FLU, &fix);
        if (step % 10 == 5) status[1] = slung_navigation_pose(&navigation, SLUNG_ENU_FLU, &fix, step % 20 == 5 ? level : NULL, 0.0625f);
        if (step % 20 == 3) status[2] = slung_navigation_height(&navigation, about_zero());
        if (step % 20 == 7) status[3] = slung_navigation_heading(&navigation, 0.5f + 0.0625f * about_zero());
        if (step % 20 == 9) status[4] = slung_navigation_magnetic_field(&navigation, SLUNG_ENU_FLU, field);
        slung_navigation_step(&navigation, SLUNG_ENU_FLU, step % 50 == 49 ? NULL : rate, force, &found);
        if (stack_used() > stack) stack = stack_used();
        take(status, sizeof status);
        take(&found, sizeof found);
    }
    print_digest("navigation", digest);
    print_stack("navigation", stack);
    return stack > STEP_STACK ? print_failure("navigation", "stack of a step") : 0;
}

int flight(void) {
    static const char *const kind[] = {"PATH_KIND", "PATH_YAW_KIND", "PATH_ACC", "PATH_NRM_1"};
    static const char *const law[] = {"CTL_LAW", "K3_0", "K3_1", "K3_2", "K3_3", "K3_4", "K3_5"};
    static const char *const sampled[] = {"CTL_LATENCY", "CTL_LAG", "OBS_W_LOAD", "OBS_W_ROD"};
    static const struct {
        const char *name;
        float values[4];
    } paths[] = {{"circle", {0, 0, 0, 0}}, {"ellipse", {1, 1, 0, 0}}, {"bent", {2, 0, 2, 0}}, {"superellipse", {3, 2, 0, 0}},
                 {"tilted", {4, 0, 0, 0.25f}}, {"fourier", {5, 1, 1, 0}}};
    static const float tracking[] = {1, 720, 1764, 1624, 735, 175, 21}, late[] = {0.01f, 0.05f, 8, 8};
    int failures = 0;
    for (unsigned i = 0; i < sizeof paths / sizeof *paths; ++i) failures += fly(paths[i].name, kind, paths[i].values, 4);
    failures += fly("tracking", law, tracking, 7);
    failures += fly("late", sampled, late, 4);
    failures += fly("route", NULL, NULL, 0);
    return failures + estimate() + navigate();
}
