/* The slung load that the examples fly: a UAV and a payload on a massless rod, in 30 lines. */
#ifndef PLANT_H
#define PLANT_H

#include "slung.h"

#include <math.h>

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

#endif
