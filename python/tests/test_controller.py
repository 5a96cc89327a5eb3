"""The supervised law, its parameters and its paths."""

import math

import numpy as np
import pytest

import slung

HOVER = 3.0 * 9.81


def hovering(position=(6.0, 0.0, -10.0)):
    return slung.State(position)


def test_parameters_are_a_mapping_that_names_what_it_refuses():
    parameters = slung.Parameters(VEH_M_LOAD=0.7)
    assert parameters["VEH_M_LOAD"] == 0.7 and dict(parameters)["VEH_ROD"] == 2.0
    assert len(parameters) == len(list(parameters)) == len(dict(parameters.items()))
    entry = slung.Parameters.entry("VEH_M_LOAD")
    assert (entry.unit, entry.default) == ("kg", 0.5)
    with pytest.raises(slung.Refused, match=r"VEH_M_LOAD = -1 is outside 0.001 to 1000") as refused:
        parameters["VEH_M_LOAD"] = -1
    assert (refused.value.field, refused.value.value, refused.value.range) == ("VEH_M_LOAD", -1.0, (0.001, 1000.0))
    assert isinstance(refused.value, ValueError) and parameters["VEH_M_LOAD"] == 0.7
    with pytest.raises(KeyError, match="VEH_COLOUR"):
        parameters["VEH_COLOUR"] = 1.0
    with pytest.raises(slung.Refused, match="not a whole number"):
        parameters["PATH_KIND"] = 0.5


def test_numpys_numbers_and_arrays_go_in_and_arrays_come_out():
    state = slung.State(np.array([1, 2, 3], np.float32), velocity=np.zeros(3), attitude=np.eye(3))
    assert state.position.dtype == np.float64 and state.position.tolist() == [1.0, 2.0, 3.0]
    assert state.attitude.shape == (3, 3)
    assert slung.Parameters(VEH_M_LOAD=np.float32(0.5))["VEH_M_LOAD"] == 0.5
    with pytest.raises(ValueError, match="length 3"):
        slung.State([1.0, 2.0])


def test_the_papers_coordinates_go_there_and_back():
    x = 0.1 * np.arange(1, 17)
    np.testing.assert_allclose(slung.State.from_paper(x).to_paper(), x, rtol=0, atol=1e-14)


@pytest.mark.parametrize("frames, position", [("ned", (1, 2, -12)), ("enu", (2, 1, 12)), ("nwu", (1, -2, 12))])
def test_a_state_is_the_same_from_any_axes(frames, position):
    below = np.subtract(position, (0, 0, -2 if frames == "ned" else 2))
    # Facing north: east-north-up's body looks along its second axis.
    facing = [[0, -1, 0], [1, 0, 0], [0, 0, 1]] if frames == "enu" else np.eye(3)
    uav = slung.Uav(position, attitude=facing, frames=frames)
    state = uav.with_load(below, (0, 0, 0), frames)
    assert state.position.tolist() == [1, 2, -10] and state.rod.tolist() == [0, 0, 1]
    np.testing.assert_array_equal(state.attitude, np.eye(3))
    down = (0, 0, 1) if frames == "ned" else (0, 0, -1)
    np.testing.assert_array_equal(uav.with_cable(2.0, down, frames=frames).position, state.position)
    state.check()


def test_bad_states_are_flown_and_told_of():
    rig = slung.Rig()
    with pytest.raises(slung.Refused, match="Rod"):
        rig.take_over(slung.State((0, 0, 0), rod=(0, 0, 2)), HOVER)
    rig.take_over(hovering(), HOVER)
    assert rig.mode == "hold"
    for bad in (slung.State((math.nan, 0, 0)), slung.State((0, 0, 0), rod=(0, 0, math.inf)), None):
        output = rig.step(bad)
        assert math.isfinite(output.thrust) and np.isfinite(output.torque).all()
        assert output.fault is not None
    with pytest.raises(slung.Refused, match="hover"):
        rig.step(None, "hover")


def test_a_rig_joins_its_path_in_the_world():
    """The circle, from a metre beside it and at rest: within a millimetre after 25 s, as the law's slowest pole of -1 has it."""
    scenario = slung.Scenario(
        path={"kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0},
        controller={"rate_hz": 500.0},
        initial={"position": [6.0, 0.0, -10.0]},
    )
    world, rig = slung.World(scenario), slung.Rig(slung.Parameters(CTL_PERIOD=0.002))
    rig.take_over(world.state, HOVER)
    modes = set()
    for _ in range(12_500):
        output = rig.step(world.read(), "follow")
        modes.add(output.mode)
        world.advance(output.thrust, output.torque)
    assert world.time_s == pytest.approx(25.0) and modes == {"join", "follow"}
    assert scenario.distance(world.state.position) < 1e-3
    assert np.linalg.norm(world.state.velocity) == pytest.approx(1.0, abs=1e-3)
    telemetry = rig.telemetry(world.state)
    assert telemetry["payload_mass"] == pytest.approx(0.5, abs=1e-3) and len(telemetry["nu"]) == 4


def test_both_arithmetics_answer_alike():
    outputs = []
    for arithmetic in ("f32", "f64"):
        rig = slung.Rig(arithmetic=arithmetic)
        rig.start(hovering((5.0, 0.1, -10.0)))
        outputs.append(rig.step(hovering((5.0, 0.1, -10.0))))
    single, double = outputs
    # Single precision has 24 bits; the law loses some ten of them.
    assert single.thrust != double.thrust and single.thrust == pytest.approx(double.thrust, rel=1e-4)


def test_an_inner_loop_is_told_rates_in_its_own_axes():
    rig = slung.Rig()
    rig.start(hovering((5.0, 0.5, -10.0)))
    output = rig.step(hovering((5.0, 0.5, -10.0)))
    np.testing.assert_allclose(output.body_rate_setpoint, 0.03 * output.angular_acceleration, rtol=1e-6)
    turned = output.in_frames("nwu")
    np.testing.assert_array_equal(turned.torque, output.torque * (1, -1, -1))
    np.testing.assert_array_equal(turned.body_rate_setpoint, output.body_rate_setpoint * (1, -1, -1))
    assert turned.thrust == output.thrust


def test_a_late_inner_loop_is_told_where_the_rate_will_be():
    rig = slung.Rig(slung.Parameters(CTL_PERIOD=0.01, CTL_LATENCY=0.02, INN_T_3=0.6))
    rig.start(hovering((5.0, 0.5, -10.0)))
    output = rig.step(slung.State((5.0, 0.5, -10.0), body_rate=(0.1, 0.0, 0.2)))
    ahead = output.body_rate_setpoint - (0.1, 0.0, 0.2)
    # Two numbers of single precision subtracted.
    np.testing.assert_allclose(ahead, output.angular_acceleration * (0.05, 0.05, 0.62), rtol=1e-5, atol=1e-7)


def test_a_function_makes_the_same_path_as_its_kind():
    """An ellipse by its formulas and as the library has it: the law's answers agree."""

    def ellipse(x, y, z):
        return (x / 4.0) ** 2 + np.square(y / 3.0) - 1, z + 10 - 0.1 * x

    own = slung.path_of(ellipse, speed=1.0, yaw=lambda x, y, z: 0.1 * np.sin(x))
    shipped = slung.Path(kind="ellipse", a=4.0, b=3.0, c0=-10.0, c1=0.1, speed=1.0, yaw="0.1*sin(x)")
    assert own.distance((4.0, 0.0, -9.6)) == pytest.approx(0.0, abs=1e-9)
    state = hovering((4.5, 0.0, -9.5))
    thrusts = []
    for path in (own, shipped):
        rig = slung.Rig(path=path, arithmetic="f64")
        rig.start(state)
        thrusts.append(rig.step(state).thrust)
    assert thrusts[0] == pytest.approx(thrusts[1], rel=1e-9)


def test_what_is_no_curve_is_refused():
    with pytest.raises(TypeError, match="smooth"):
        slung.path_of(lambda x, y, z: (x if x else y, z), speed=1.0)
    with pytest.raises(TypeError, match="'>' not supported"):
        slung.path_of(lambda x, y, z: (x if x > 0 else -x, z), speed=1.0)
    with pytest.raises(TypeError, match="numpy.absolute"):
        slung.path_of(lambda x, y, z: (np.abs(x) - 5, z), speed=1.0)
    with pytest.raises(slung.Refused, match="radius: -5 is outside") as refused:
        slung.Path(kind="circle", radius=-5.0, p3=-10.0, speed=1.0)
    assert refused.value.field == "radius"
    with pytest.raises(slung.Refused, match="no path of kind"):
        slung.Path(kind="helix", speed=1.0)
    report = slung.Path(kind="circle", radius=5.0, p3=-10.0, speed=1.0).check()
    assert "closed, smooth and regular" in report


def test_a_route_pauses_goes_on_and_ends_on_the_ground():
    points = [[0.0, 0.0, -4.0], [6.0, 0.0, -4.0], [6.0, 4.0, -4.0]]
    route = slung.Path(kind="route", points=points, speed=1.5, corner_m=1.0, end="land", stops=[{"index": 1, "dwell_s": 1e5}])
    scenario = slung.Scenario(
        path=route, ground={}, initial={"position": points[0]}, controller={"law": "follow", "rate_hz": 500.0}, duration_s=200.0
    )
    world = slung.World(scenario)
    rig = slung.Rig(slung.Parameters(CTL_PERIOD=0.002), route)
    rig.take_over(world.state, thrust=29.43)
    with pytest.raises(slung.Refused, match="factor = 3 is outside -2 to 2"):
        rig.set_speed_factor(3.0)
    assert not rig.go_on()

    def fly(seconds):
        for _ in range(round(seconds / 0.002)):
            output = rig.step(world.read(), "follow", uav=world.uav)
            world.advance(output.thrust, output.torque)
        return output

    while world.state.position[0] < 1.0:
        fly(0.5)
        assert world.time_s < 30.0
    rig.set_speed_factor(0.0)
    fly(8.0)
    paused = world.state.position
    fly(3.0)
    assert np.abs(world.state.position - paused).max() < 1e-3 and 1.0 < paused[0] < 5.9
    rig.set_speed_factor(1.0)
    fly(25.0)
    assert rig.go_on() and not rig.is_over
    fly(60.0)
    # At rest is 10 mm/s, and the stop's rate 0.5/s: landing begins within 2 cm of the end.
    assert rig.is_over and world.on_ground == (True, True) and rig.mode == "off"
    assert np.abs(world.state.position[:2] - points[2][:2]).max() < 0.5
