"""The load found from an autopilot's own sensors, in the simulator's world."""

import numpy as np

import slung

HOVER = 3.0 * 9.81


def test_the_law_flies_on_what_the_filters_find():
    """RTK GNSS and an IMU, no sensor on the load: the README's case in calm air, whose worst of 16 flights is 80 mm."""
    scenario = slung.Scenario(
        path={"kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0},
        controller={"rate_hz": 500.0},
        initial={"position": [5.5, 0.0, -10.0]},
        sensors={"imu": {}, "gnss": {}, "magnetometer": {}},
    )
    parameters = slung.Parameters(CTL_PERIOD=0.002)
    world, rig = slung.World(scenario, seed=2), slung.Rig(parameters)
    imu = (0.0, 0.0, 0.0)
    navigation = slung.Navigation(parameters, world.uav, imu=imu)
    load = slung.PayloadFilter(parameters, imu=imu)
    rig.take_over(world.state, HOVER)
    thrust, distances, estimate = HOVER, [], None
    for step in range(15_000):
        readings = world.instruments()
        uav = navigation.step(readings["body_rate"], readings["specific_force"])
        if "fix" in readings:
            navigation.fix(**readings["fix"])
        if "field" in readings:
            navigation.magnetic_field(readings["field"])
        estimate = load.step(uav, navigation.specific_force, thrust)
        output = rig.step(estimate.state, "follow")
        world.advance(output.thrust, output.torque)
        thrust = output.thrust
        if step > 12_000:
            distances.append(scenario.distance(world.state.position))
    assert estimate.validity == "valid" and estimate.is_taut
    off = np.degrees(np.arccos(np.clip(world.state.rod @ estimate.state.rod, -1, 1)))
    assert off < 1.5, f"{off} degrees"
    assert max(distances) < 0.25, f"{max(distances)} m"
