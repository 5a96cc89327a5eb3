/* A payload of 0.5 kg on a circle of 5 m at 1 m/s, from a hover 1 m beside it: 30 s against the plant in plant.h. */
#include "plant.h"

#include <stdio.h>

int main(void) {
    static slung_parameters parameters;
    static slung_controller controller;
    slung_error error = {sizeof error, 0, "", 0, 0, 0, -1};
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
