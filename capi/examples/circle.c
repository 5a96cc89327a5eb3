/* A payload of 0.5 kg on a circle of 5 m at 1 m/s, from a hover 1 m beside it: 30 s against a plant of 30 lines. */
#include "slung.h"

#include <math.h>
#include <stdio.h>

#define PERIOD 0.002f
static const float UAV_MASS = 2.5f, PAYLOAD_MASS = 0.5f, LENGTH = 2.0f, GRAVITY = 9.81f;
static const float INERTIA[3] = {0.03f, 0.03f, 0.05f};

static float dot(const float a[3], const float b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* One period of the slung load under a held command, by explicit Euler steps of a twentieth of it. */
static void fly(slung_state *s, float thrust, const float torque[3]) {
    const int steps = 20;
    const float h = PERIOD / (float)steps, total = UAV_MASS + PAYLOAD_MASS;
    for (int n = 0; n < steps; ++n) {
        float *r = s->attitude_frd_to_ned, *w = s->body_rate_frd_rad_s, *q = s->rod_ned, *qd = s->rod_rate_ned_1_s;
        const float b3[3] = {r[2], r[5], r[8]}, along = dot(b3, q), swing = dot(qd, qd), turned[9] = {
            r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]};
        for (int i = 0; i < 3; ++i) {
            const float pull = -(LENGTH * UAV_MASS * swing + along * thrust) / total;
            const float v_dot = pull * q[i] + (i == 2 ? GRAVITY : 0.0f);
            const float q_ddot = -swing * q[i] + (b3[i] - along * q[i]) * thrust / (UAV_MASS * LENGTH);
            s->payload_position_ned_m[i] += h * s->payload_velocity_ned_m_s[i];
            s->payload_velocity_ned_m_s[i] += h * v_dot;
            q[i] += h * qd[i];
            qd[i] += h * q_ddot;
            r[3 * i] += h * (turned[3 * i + 1] * w[2] - turned[3 * i + 2] * w[1]);
            r[3 * i + 1] += h * (turned[3 * i + 2] * w[0] - turned[3 * i] * w[2]);
            r[3 * i + 2] += h * (turned[3 * i] * w[1] - turned[3 * i + 1] * w[0]);
        }
        const float j[3] = {INERTIA[0], INERTIA[1], INERTIA[2]}, o[3] = {w[0], w[1], w[2]};
        w[0] += h * (torque[0] + (j[1] - j[2]) * o[1] * o[2]) / j[0];
        w[1] += h * (torque[1] + (j[2] - j[0]) * o[2] * o[0]) / j[1];
        w[2] += h * (torque[2] + (j[0] - j[1]) * o[0] * o[1]) / j[2];
        const float length = sqrtf(dot(q, q));
        for (int i = 0; i < 3; ++i) q[i] /= length;
    }
}

int main(void) {
    static slung_parameters parameters;
    static slung_controller controller;
    slung_error error = {sizeof error, 0, "", 0, 0, 0};
    slung_output output = {0};
    output.struct_size = sizeof output;
    if (slung_abi_version() != SLUNG_ABI_VERSION) return 1;
    slung_parameters_default(&parameters, sizeof parameters);
    if (slung_parameters_set(&parameters, "PATH_SPEED", 1.0f, &error) != SLUNG_OK ||
        slung_create(&controller, sizeof controller, &parameters, &error) != SLUNG_OK) {
        fprintf(stderr, "%s: %s = %g, allowed %g to %g\n", slung_status_text(error.status), error.field, (double)error.value,
                (double)error.min, (double)error.max);
        return 1;
    }
    slung_state state = {{6, 0, -10}, {0}, {0, 0, 1}, {0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}};
    const slung_wrench hover = {(UAV_MASS + PAYLOAD_MASS) * GRAVITY, {0}};
    slung_take_over(&controller, &state, &hover);
    float worst = 0.0f;
    for (int n = 0; n < 15000; ++n) {
        slung_step(&controller, &state, SLUNG_FOLLOW, &output);
        fly(&state, output.thrust_n, output.torque_frd_n_m);
        const float *p = state.payload_position_ned_m, away = hypotf(hypotf(p[0], p[1]) - 5.0f, p[2] + 10.0f);
        if (n >= 10000 && away > worst) worst = away;
        if (n % 2500 == 0) printf("%4.0f s  %-20s %8.4f m from the circle\n", n * (double)PERIOD, slung_mode_text(output.mode), (double)away);
    }
    printf("farthest in the last 10 s: %.1f mm\n", (double)worst * 1000.0);
    return worst < 0.005f && output.mode == SLUNG_MODE_FOLLOW ? 0 : 1;
}
