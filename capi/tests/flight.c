/* Flies every kind of path and law for 500 steps and prints a digest of each byte that comes out: on a host and on a target
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

static int fly(const char *name, const char *const names[], const float values[], int count) {
    static slung_parameters parameters;
    static slung_controller controller;
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
    if (slung_create(&controller, sizeof controller, &parameters, NULL) != SLUNG_OK) return print_failure(name, "create");
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
        slung_step(&controller, step % 50 == 49 ? NULL : &state, step < 450 ? SLUNG_FOLLOW : SLUNG_LAND, &output);
        slung_telemetry_of(&controller, &state, &telemetry);
        take(&output, sizeof output);
        take(&telemetry, sizeof telemetry);
    }
    print_digest(name, digest);
    return 0;
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
    return failures;
}
