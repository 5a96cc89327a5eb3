"""The law above an autopilot's own rate loop: 100 setpoints a second of body rate and thrust, 20 ms late, motors of 30 ms.

    python rate_loop.py

The autopilot is the scenario's: about each axis it turns an error of body rate into the torque that would remove it with the loop's
time constant, 1,000 times a second. The law is told that time constant (`INN_T_1` to `INN_T_3`) and the latency; the motors' lag is the
loop's own to make good.
"""

import slung

RATE_HZ, LATENCY, MOTORS, LOOP = 100.0, 0.02, 0.03, 0.03
HOVER = 3.0 * 9.81

CIRCLE = slung.Path(kind="circle", radius=5.0, p3=-10.0, speed=1.0)
ROUTE = slung.Path(
    kind="route",
    points=[[5.0, 0.0, -10.0], [5.0, 15.0, -10.0], [-10.0, 15.0, -12.0], [-10.0, 0.0, -10.0]],
    corner_m=5.0,
    closed=True,
    speed=1.0,
)


def fly(path, duration_s, judged_from_s):
    """The largest distance from the path from some time on, m."""
    scenario = slung.Scenario(
        path=path,
        controller={"rate_hz": RATE_HZ},
        actuators={"latency_s": LATENCY, "lag_s": MOTORS, "rate_loop": {"rate_hz": 1000.0, "time_constant_s": [LOOP] * 3}},
        initial={"position": [6.0, 0.0, -10.0]},
    )
    parameters = slung.Parameters(
        CTL_PERIOD=1.0 / RATE_HZ, CTL_LATENCY=LATENCY, INN_T_1=LOOP, INN_T_2=LOOP, INN_T_3=LOOP
    )
    world, rig = slung.World(scenario), slung.Rig(parameters, path)
    rig.take_over(world.state, HOVER)
    worst = 0.0
    for step in range(round(duration_s * RATE_HZ)):
        output = rig.step(world.state, "follow")
        world.advance_at_rates(output.thrust, output.body_rate_setpoint)
        if step >= judged_from_s * RATE_HZ:
            worst = max(worst, path.distance(world.state.position))
    assert output.mode == "follow", output
    return worst


def main():
    for name, path in (("circle", CIRCLE), ("route", ROUTE)):
        worst = fly(path, duration_s=75.0, judged_from_s=30.0)
        print(f"{name}: at most {1e3 * worst:.2f} mm from it from 30 s on")
        assert worst < 1e-3


if __name__ == "__main__":
    main()
