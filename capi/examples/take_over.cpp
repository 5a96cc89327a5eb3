// Takes over a hovering vehicle whose numbers come in ROS's axes (east, north, up; forward, left, up) and whose autopilot takes
// body rates and thrust: what a companion computer does.
#include "slung.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace {

// A hover at 12 m with the payload 2 m below, 6 m north of the circle's axis, drifting east.
slung_uav hovering() {
    slung_uav uav{};
    const std::array<float, 3> position{0.0F, 6.0F, 12.0F}, velocity{0.2F, 0.0F, 0.0F};
    for (std::size_t i = 0; i < 3; ++i) {
        uav.position_world_m[i] = position[i];
        uav.velocity_world_m_s[i] = velocity[i];
    }
    // Nose north: a quarter turn from east about up.
    uav.quaternion_body_to_world[0] = std::sqrt(0.5F);
    uav.quaternion_body_to_world[3] = std::sqrt(0.5F);
    return uav;
}

int refused(const char *what, int32_t status) {
    std::fprintf(stderr, "%s: %s\n", what, slung_status_text(status));
    return 1;
}

}  // namespace

int main() {
    static slung_parameters parameters;
    static slung_controller controller;
    slung_error error{};
    error.struct_size = sizeof error;
    slung_parameters_default(&parameters, sizeof parameters);

    // A mistake is told with its field, value and range, and changes nothing.
    if (slung_parameters_set(&parameters, "VEH_M_LOAD", -1.0F, &error) != SLUNG_OUT_OF_RANGE) return 1;
    std::printf("refused, as it should be: %s = %g is outside %g to %g\n", error.field, double(error.value), double(error.min),
                double(error.max));

    // The autopilot's rate loop: 30 ms in roll and pitch, 0.6 s in yaw.
    for (const char *name : {"INN_T_1", "INN_T_2"})
        if (const int32_t status = slung_parameters_set(&parameters, name, 0.03F, &error)) return refused(name, status);
    if (const int32_t status = slung_parameters_set(&parameters, "INN_T_3", 0.6F, &error)) return refused("INN_T_3", status);
    if (const int32_t status = slung_create(&controller, sizeof controller, &parameters, &error)) return refused(error.field, status);

    const slung_uav uav = hovering();
    const float payload[3] = {0.0F, 6.0F, 10.0F}, velocity[3] = {0.2F, 0.0F, 0.0F};
    slung_state state;
    if (const int32_t status = slung_state_from_payload(SLUNG_ENU_FLU, &uav, payload, velocity, &state))
        return refused("state", status);

    const slung_wrench applied = {3.0F * 9.81F, {0.0F, 0.0F, 0.0F}};
    if (const int32_t status = slung_take_over(&controller, &state, &applied)) return refused("take over", status);
    slung_output output{};
    output.struct_size = sizeof output;
    if (const int32_t status = slung_step(&controller, &state, SLUNG_HOLD, &output)) return refused("step", status);
    slung_output_in(SLUNG_ENU_FLU, &output);
    std::printf("%s: thrust %.2f N (%.1f %%), body rates %+.4f %+.4f %+.4f rad/s forward, left, up\n", slung_mode_text(output.mode),
                double(output.thrust_n), 100.0 * double(output.thrust_normalized), double(output.body_rate_setpoint_frd_rad_s[0]),
                double(output.body_rate_setpoint_frd_rad_s[1]), double(output.body_rate_setpoint_frd_rad_s[2]));

    // The first command takes up where the last one left off: no bump.
    const bool is_smooth = output.mode == SLUNG_MODE_HOLD && std::fabs(output.thrust_n - applied.thrust_n) < 0.05F;
    return is_smooth ? 0 : 1;
}
