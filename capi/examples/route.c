/* A route with a stop, flown from an IMU and a receiver alone: nobody measures the load. Hold until its estimate is good, join, rest
 * at the stop, pause on the way, and land where the route ends. */
#include "instruments.h"

#include <stdio.h>

/* Why a call was refused, in words. */
static int refused(const char *what, int32_t status, const slung_error *error) {
    if (status == SLUNG_OK) return 0;
    fprintf(stderr, "%s: %s", what, slung_status_text(status));
    if (error->status == status) {
        fprintf(stderr, ": %s = %g, allowed %g to %g", error->field, (double)error->value, (double)error->min, (double)error->max);
        if (error->waypoint >= 0) fprintf(stderr, ", waypoint %d", (int)error->waypoint);
    }
    fputc('\n', stderr);
    return 1;
}

int main(void) {
    static slung_parameters parameters;
    static slung_navigation navigation;
    static slung_estimator estimator;
    static slung_controller controller;
    static slung_route route;
    static slung_knot knots[256];
    static slung_run runs[4];
    slung_error error = {sizeof error, 0, "", 0, 0, 0, -1};
    slung_navigated found = {0};
    slung_estimate load = {0};
    slung_progress progress = {0};
    slung_output output = {0};
    found.struct_size = sizeof found;
    load.struct_size = sizeof load;
    progress.struct_size = sizeof progress;
    output.struct_size = sizeof output;

    slung_parameters_default(&parameters, sizeof parameters);
    slung_parameters_set(&parameters, "CTL_PERIOD", PERIOD, &error);

    /* North, east, down in m; blend of the corner, speed, yaw along the route, how long it rests. */
    slung_waypoint points[] = {
        {{0, 0, -10}, 2, 1.5f, NAN, -1},
        {{12, 0, -10}, 2, 1.5f, NAN, 5}, /* a stop of 5 s */
        {{12, 9, -12}, 2, 1.5f, NAN, -1},
        {{0, 9, -12}, 2, 1.5f, NAN, -1},
    };
    points[2].speed_m_s = -1.0f; /* a mistake is told with its field, range and waypoint, and changes nothing */
    if (!refused("as it should be", slung_route_build(&route, sizeof route, points, 4, 0, NULL, knots, 256, runs, 4, &error), &error))
        return 1;
    points[2].speed_m_s = 1.5f;
    if (refused("route", slung_route_build(&route, sizeof route, points, 4, 0, NULL, knots, 256, runs, 4, &error), &error)) return 1;
    slung_route_land(&route, 1);
    if (refused("controller", slung_create_on(&controller, sizeof controller, &parameters, &route, &error), &error)) return 1;

    /* Hovering at rest, nose north, 1 m beside the route's beginning. */
    slung_state state = {{0, 1, -10}, {0}, {0, 0, 1}, {0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}};
    const slung_wrench hover = {(UAV_MASS + PAYLOAD_MASS) * GRAVITY, {0}};
    float specific_force[3] = {0, 0, -GRAVITY}, velocity[3];
    slung_uav start;
    slung_navigation_at_rest(SLUNG_NED_FRD, specific_force, 0.0f, &start);
    uav_of(&state, start.position_world_m, velocity);
    if (refused("navigation",
                slung_navigation_create(&navigation, sizeof navigation, &parameters, NULL, SLUNG_NED_FRD, &start, &error), &error) ||
        refused("estimator", slung_estimator_create(&estimator, sizeof estimator, &parameters, NULL, &error), &error))
        return 1;

    float worst = 0.0f;
    output.thrust_n = hover.thrust_n;
    for (int n = 0; n < 60000 && output.mode != SLUNG_MODE_LAND; ++n) {
        if (n % 50 == 0) { /* an RTK receiver, 10 Hz; give age_s where it is late */
            slung_fix fix = {{0}, {0}, {0.01f, 0.02f}, {0.03f, 0.05f}, 0.0f};
            uav_of(&state, fix.position_world_m, fix.velocity_world_m_s);
            slung_navigation_fix(&navigation, SLUNG_NED_FRD, &fix);
        }
        slung_navigation_step(&navigation, SLUNG_NED_FRD, state.body_rate_frd_rad_s, specific_force, &found);
        slung_estimator_step(&estimator, SLUNG_NED_FRD, &found.uav, found.specific_force_body_m_s2, output.thrust_n, &load);
        if (n == 0) slung_take_over(&controller, &load.state, &hover);

        const uint32_t wanted = n < 5000 ? SLUNG_HOLD : SLUNG_FOLLOW;
        slung_step_measured(&controller, load.validity == SLUNG_VALID ? &load.state : NULL, SLUNG_NED_FRD, &load.uav,
                            found.specific_force_body_m_s2, wanted, &output);
        if (n == 27500) slung_set_speed_factor(&controller, 0.0f); /* pause, */
        if (n == 31000) slung_set_speed_factor(&controller, 1.0f); /* and go on */

        slung_progress_of(&controller, &progress);
        const float *p = state.payload_position_ned_m, *c = progress.nearest_ned_m;
        const float away = hypotf(hypotf(p[0] - c[0], p[1] - c[1]), p[2] - c[2]);
        if (output.mode == SLUNG_MODE_FOLLOW && away > worst) worst = away;
        if (n % 2500 == 0)
            printf("%4.0f s  %-20s run %u of %u%s  %6.2f %6.2f %6.2f m, %.3f m off\n", n * (double)PERIOD, slung_mode_text(output.mode),
                   (unsigned)progress.run + 1, (unsigned)progress.runs, progress.rests ? ", at rest" : "", (double)p[0], (double)p[1],
                   (double)p[2], (double)away);
        fly_and_feel(&state, &output, specific_force);
    }
    printf("%s at the route's end; farthest from the route: %.0f mm\n", slung_mode_text(output.mode), (double)worst * 1000.0);
    return output.mode == SLUNG_MODE_LAND && progress.is_over && worst < 0.1f ? 0 : 1;
}
