/* What the plant's UAV knows of itself: its place, its attitude, and what its accelerometer feels. */
#ifndef INSTRUMENTS_H
#define INSTRUMENTS_H

#include "plant.h"

/* The UAV's place and velocity. */
static inline void uav_of(const slung_state *s, float position[3], float velocity[3]) {
    for (int i = 0; i < 3; ++i) {
        position[i] = s->payload_position_ned_m[i] - LENGTH * s->rod_ned[i];
        velocity[i] = s->payload_velocity_ned_m_s[i] - LENGTH * s->rod_rate_ned_1_s[i];
    }
}

/* Its attitude as a quaternion (w, x, y, z), while it is turned by less than half a turn. */
static inline void quaternion_of(const slung_state *s, float quaternion[4]) {
    const float *r = s->attitude_frd_to_ned, w = 0.5f * sqrtf(1.0f + r[0] + r[4] + r[8]);
    quaternion[0] = w;
    quaternion[1] = (r[7] - r[5]) / (4.0f * w);
    quaternion[2] = (r[2] - r[6]) / (4.0f * w);
    quaternion[3] = (r[3] - r[1]) / (4.0f * w);
}

/* A period of the plant, and what its accelerometer has as the mean of it, in body axes. */
static inline void fly_and_feel(slung_state *s, const slung_output *output, float specific_force[3]) {
    float p[3], before[3], after[3];
    uav_of(s, p, before);
    fly(s, output->thrust_n, output->torque_frd_n_m);
    uav_of(s, p, after);
    for (int i = 0; i < 3; ++i) {
        specific_force[i] = 0.0f;
        for (int k = 0; k < 3; ++k)
            specific_force[i] += s->attitude_frd_to_ned[3 * k + i] * ((after[k] - before[k]) / PERIOD - (k == 2 ? GRAVITY : 0.0f));
    }
}

#endif
