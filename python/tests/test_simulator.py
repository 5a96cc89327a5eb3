"""Scenarios, flights, comparisons, campaigns."""

import threading
import time

import numpy as np
import pytest

import slung


def test_the_papers_figure_is_flown_as_it_is_printed():
    flight = slung.run(slung.Scenario("fig3a"))
    assert flight.failure is None
    # hil-sim/scenarios/reference.toml: a period of 1 ms, and what single precision loses.
    assert flight.results["settle_s"] == pytest.approx(6.637, abs=2e-3)
    assert flight.results["effort_n_s"] == pytest.approx(7.405, abs=2e-3)
    log = flight.log
    assert log["t_s"][-1] == pytest.approx(10.0) and len(log["p1"]) == len(log["t_s"]) == len(log["mode"])
    assert np.hypot(log["p1"], log["p2"])[-1] == pytest.approx(5.0, abs=1e-3)
    assert flight.quantities["thrust"][0] == "N" and set(flight.quantities) == set(log)


def test_a_route_through_points_is_flown():
    """A figure eight that crosses itself, smoothly through an array of points: within a millimetre in calm air after joining."""
    t = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    points = np.column_stack([6 * np.cos(t), 6 * np.sin(t) * np.cos(t), np.full_like(t, -10.0)])
    # Their spacing changes, so that it passes by some of them, by centimetres.
    path = slung.Path(kind="route", points=points, closed=True, corner_m="smooth", speed=1.5, yaw="tangent")
    assert path.outline().shape == (257, 3) and path.distance(points[5]) < 0.1
    flight = slung.run(slung.Scenario("figure-eight", path=path, duration_s=45.0))
    assert flight.failure is None
    assert flight.log["d_c"][flight.log["t_s"] >= 30.0].max() < 1e-3
    with pytest.raises(slung.Refused, match="points"):
        slung.Path(kind="route", points=[[0.0, 0.0, -10.0]], speed=1.0)


def test_a_flown_log_is_replayed(tmp_path):
    scenario = slung.Scenario("fig3a", duration_s=4.0)
    log = slung.run(scenario).log
    columns = {name: values for name, values in log.items() if isinstance(values, np.ndarray)}
    file = tmp_path / "flown.csv"
    np.savetxt(file, np.column_stack(list(columns.values())), delimiter=",", header=",".join(columns), comments="")
    replayed = slung.replay(file, scenario, from_s=1.0)
    assert replayed.failure is None and replayed.said
    answer = replayed.log
    assert answer["t_s"][-1] == pytest.approx(3.0, abs=0.01)
    # Given the logged loads the law says again what it said, 29.43 N in hover: measured 0.0007 N, by cubics between samples 20 ms apart.
    assert np.abs(answer["thrust"] - answer["logged_thrust"])[100:-1].max() < 3e-3
    with pytest.raises(ValueError, match="the log has 0.000 to 4.000 s"):
        slung.replay(file, scenario, from_s=5.0)
    with pytest.raises(slung.Refused, match="full_thrust = -1"):
        slung.replay(file, scenario, full_thrust=-1.0)


def test_every_built_in_scenario_can_be_had():
    assert {"fig2a", "fig3b", "knot", "building", "survey-rows"} <= set(slung.Scenario.names())
    for name in slung.Scenario.names():
        assert slung.Scenario(name).name == name


def test_scenarios_come_from_files_and_mappings(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('title = "Mine"\nduration_s = 2.0\n[vehicle]\npayload_mass = 0.7\n')
    mine = slung.Scenario(file)
    assert (mine.name, mine.title, mine.duration_s) == ("mine", "Mine", 2.0)
    changed = mine.replace(vehicle={"uav_mass": np.float64(3.0)}, initial={"position": np.array([0.0, 6.0, -10.0])})
    assert changed.keys["vehicle"] == {"payload_mass": 0.7, "uav_mass": 3.0}
    assert slung.run(slung.Scenario(changed.keys)).log["p2"][0] == 6.0
    assert slung.Scenario(path=slung.Path(kind="circle", radius=3.0, p3=-9.0, speed=1.0)).distance((3, 0, -9)) == 0.0


def test_what_is_wrong_in_a_scenario_is_named(tmp_path):
    with pytest.raises(slung.Refused, match="duration_s: -1 is outside 0.01 to 100000") as refused:
        slung.Scenario(duration_s=-1)
    assert refused.value.field == "duration_s"
    with pytest.raises(slung.Refused, match="colour"):
        slung.Scenario(vehicle={"colour": 1.0})
    with pytest.raises(TypeError, match="vehicle: a object is no value"):
        slung.Scenario(vehicle=object())
    with pytest.raises(FileNotFoundError, match="nowhere.toml: .*fig3a"):
        slung.Scenario("nowhere.toml")
    file = tmp_path / "wrong.toml"
    file.write_text("title = 'x'\nduration_s = 'long'\n")
    with pytest.raises(slung.Refused, match="wrong.toml:2: duration_s"):
        slung.Scenario(file)


def test_a_worlds_flight_is_a_function_of_its_seed():
    scenario = slung.Scenario(sensors={"position": {"noise": 0.02}}, controller={"rate_hz": 500.0})

    def positions(seed, run=0):
        world = slung.World(scenario, seed=seed, run=run)
        seen = []
        for _ in range(5):
            seen.append(world.read().position)
            world.advance(29.43)
        return np.array(seen)

    np.testing.assert_array_equal(positions(3), positions(3))
    assert (positions(3) != positions(4)).any() and (positions(3) != positions(3, 1)).any()
    world = slung.World(scenario)
    with pytest.raises(slung.Refused, match="thrust = NaN is outside"):
        world.advance(float("nan"))


def test_a_world_has_ground_and_a_cable_that_can_be_slack():
    scenario = slung.Scenario(
        initial={"position": [0.5, 0.0, 0.0], "uav_position": [0.0, 0.0, 0.0], "standing": True},
        ground={"p3": 0.0},
        controller={"rate_hz": 500.0},
    )
    world = slung.World(scenario, thrust=0.0)
    assert world.on_ground == (True, True) and world.pull == 0.0
    world.advance(35.0, periods=1000)
    assert world.on_ground == (False, False) and world.pull > 1.0


def test_comparisons_are_rows_by_columns():
    rows = slung.compare(2, cases=["nominal", "force-1N"])
    assert list(rows["case"]) == ["nominal"] * 4 + ["force-1N"] * 4
    assert rows["runs"].tolist() == [2] * 8
    observer = rows["law"] == "observer"
    assert (rows["good"][observer] == 2).all() and rows["median_dc_m"][observer].max() < 0.01
    with pytest.raises(slung.Refused, match="hail"):
        slung.compare(1, cases=["hail"])


def test_campaigns_are_the_same_on_any_number_of_threads():
    campaign = slung.Campaign()
    one, two = campaign.run(3, seed=5, jobs=1), campaign.run(3, seed=5, jobs=2)
    assert one.keys() == two.keys() and list(one["run"]) == [0, 1, 2]
    for name in one:
        np.testing.assert_array_equal(one[name], two[name])
    row, log = campaign.replay(1, seed=5)
    assert row["dc_max_m"] == one["dc_max_m"][1]
    np.testing.assert_allclose([log["p1"][0], log["p2"][0]], campaign.start(1, seed=5).position[:2], rtol=1e-6)
    with pytest.raises(slung.Refused, match="path.kind: no path"):
        slung.Campaign({"scenario": {"path": {"kind": "helix", "speed": 1.0}}})


def test_counts_and_names_of_campaigns_are_refused_with_what_they_may_be():
    assert slung.Campaign("ground-to-ground").title != slung.Campaign().title
    with pytest.raises(FileNotFoundError, match="nosuch.*ground-to-ground"):
        slung.Campaign("nosuch")
    for refuse in (lambda: slung.Campaign().run(-4), lambda: slung.compare(0)):
        with pytest.raises(slung.Refused, match="runs = .* is outside 1 to") as refused:
            refuse()
        assert refused.value.field == "runs" and refused.value.range == (1.0, 1e8)


def test_others_run_while_a_flight_does():
    """A thread that counts goes on counting: a flight holds no lock."""
    scenario = slung.Scenario("fig3a", duration_s=200.0)
    counted, flying = [], threading.Event()

    def count():
        while flying.is_set():
            counted.append(time.perf_counter())
            time.sleep(0.001)

    flying.set()
    thread = threading.Thread(target=count)
    thread.start()
    begun = time.perf_counter()
    slung.run(scenario)
    ended = time.perf_counter()
    flying.clear()
    thread.join()
    during = [moment for moment in counted if begun < moment < ended]
    # Held for the whole flight, none or one would be left.
    assert len(during) >= 5, f"{len(during)} in {ended - begun} s"
