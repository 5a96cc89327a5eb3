"""Flies the same cases in the simulator and in MuJoCo, and holds them to each other.

    python flights.py target/release/hil-sim

Commands are open loop but for the missions, which the project's controller flies: what differs in the others grows with nothing that
corrects it. Ends with status 0 if every
flight agrees within its bound.
"""

import math
import pathlib
import sys
import tempfile
import time

import numpy as np

from plants import GRAVITY, Case, MuJoCo, Pilot, Simulator

HOVER = 2.5 * GRAVITY


def constant(thrust):
    return lambda t, state: (thrust, (0.0, 0.0, 0.0))


def rocking(thrust):
    """Torques that tilt the vehicle by some 20° and bring it back, about all axes."""
    return lambda t, state: (thrust, (0.06 * math.sin(3.0 * t), 0.05 * math.sin(2.5 * t), 0.01 * math.sin(2.0 * t)))


def swing(angle, case, speed=0.0):
    """The payload's place and velocity across, of a rod or cable from the hook at this angle about the second axis, UAV level."""
    along = np.array((math.sin(angle), 0.0, math.cos(angle)))
    across = np.array((math.cos(angle), 0.0, -math.sin(angle)))
    place = np.add(case.uav_position, case.hook) + along * case.length
    return dict(position=tuple(place), velocity=tuple(across * speed))


def with_swing(angle, speed=0.0, **what):
    case = Case(**what)
    return Case(**{**what, **swing(angle, case, speed)})


def mission(length, payload_mass=0.5, uav_mass=2.5, inertia=(0.03, 0.03, 0.05), standing=True, aside=0.5, **what):
    """The controller's own flight: off the ground with a slack cable, along the path, and back; or down from a hover."""
    size = (payload_mass / 0.5) ** (1 / 3)
    body = dict(payload_height=0.05 * size, feet_below=0.15 * size, feet_apart=0.2 * size)
    if standing:
        risen = 5.0 + (length + 1.0) / 0.4
        asked = ((0.0, "idle"), (1.0, "hold"), (risen, "follow"), (risen + 20.0, "hold"), (risen + 28.0 + 1.2 * length, "land"))
        # In MuJoCo a body at rest touches the surface; here it has sunk in by 2 mm.
        position, uav_position = (aside, 0.0, -body["payload_height"]), (0.0, 0.0, -body["feet_below"])
    else:
        asked = ((0.0, "land"),)
        position, uav_position = (0.0, 0.0, -1.05), (0.0, 0.0, -1.05 - length)
    return Case(
        length=length, payload_mass=payload_mass, uav_mass=uav_mass, inertia=inertia, ground=True, position=position,
        uav_position=uav_position, period=0.004, step=5e-4, mission=asked, standing=standing, **body, **what,
    )


# Bounds, m, and why. The rod is exact in both, and only two methods of order 4 and the payload's own
# inertia of 1e-7 kg·m² in MuJoCo are left. An elastic cable is integrated there to first order in
# 0.1 ms at up to 80 rad/s: some 1e-3 of the way it drives. A limit is an overdamped spring there and
# a constraint here: a hundredth of the jerk's 4 m/s thrown back, for hundredths of a second. On the
# ground the weight sinks in by 2 mm here and by nothing there, where it does not slow the rebound
# either: a critically damped fall at 3.3 m/s comes back with exp(-2) of it, 1 cm high at the most.
RIGID, ELASTIC, JERK, GROUND = 1e-4, 1e-3, 1e-3, 2e-2
ROD = dict(link="rod", step=5e-4)

OPEN = {
    "rod, swinging": (with_swing(0.5, 0.4, **ROD), constant(31.0), 3.0, RIGID),
    "rod, rocked": (with_swing(-0.3, **ROD), rocking(30.0), 3.0, RIGID),
    "rod of 0.5 m, payload of the UAV's mass": (
        with_swing(0.4, 0.3, **ROD, payload_mass=2.5, length=0.5), rocking(50.0), 2.0, RIGID),
    "hook 20 cm below": (with_swing(0.3, **ROD, hook=(0.0, 0.0, 0.2)), rocking(30.0), 2.0, RIGID),
    "hook 5 cm aside": (with_swing(0.2, **ROD, hook=(0.05, 0.02, 0.1)), constant(30.0), 1.0, RIGID),
    "elastic, 2 % of static stretch": (
        with_swing(0.4, link="elastic", ea=0.5 * GRAVITY / 0.02, damping=0.5), rocking(30.0), 2.0, ELASTIC),
    "elastic, 3 mm of polyamide": (
        with_swing(0.2, 0.3, link="elastic", ea=5e3, damping=4.0), constant(30.0), 2.0, ELASTIC),
    "elastic, 10 kg on 15 m": (
        with_swing(0.2, link="elastic", ea=10 * GRAVITY / 0.02, damping=20.0, payload_mass=10.0, uav_mass=25.0,
                   length=15.0, inertia=(1.0, 1.0, 1.8)), constant(350.0), 3.0, ELASTIC),
    "slack, falls 0.8 m, jerks": (Case(position=(0.0, 0.0, -10.8), uav_position=(0.0, 0.0, -12.0)), constant(HOVER + 4.9), 1.0, JERK),
    "slack, thrown aside, jerks at a hook": (
        Case(position=(0.8, 0.0, -11.2), velocity=(1.0, 0.5, 0.0), hook=(0.0, 0.0, 0.1)), constant(HOVER + 4.9), 0.8, JERK),
    "payload dropped on the ground, sliding": (
        Case(ground=True, damping_ratio=1.0, length=20.0, position=(0.0, 0.0, -0.6), velocity=(1.0, 0.0, 0.0), uav_position=(0.0, 0.0, -10.0)),
        constant(HOVER), 1.5, GROUND),
    "off the ground, payload lifted from beside": (
        Case(ground=True, position=(0.4, 0.0, -0.05), uav_position=(0.0, 0.0, -0.15)), constant(31.0), 2.0, GROUND),
}

HEAVY = dict(payload_mass=10.0, uav_mass=50.0, inertia=(4.4, 4.4, 7.4))
LIGHT = dict(payload_mass=0.1, uav_mass=0.5, inertia=(0.002, 0.002, 0.0034))
MISSIONS = {
    "down from a hover, rope 0.5 m": mission(0.5, standing=False),
    "down from a hover, rope 15 m": mission(15.0, standing=False),
    "down from a hover, 10 kg": mission(5.0, **HEAVY, standing=False),
    "down from a hover, 0.1 kg": mission(2.0, **LIGHT, standing=False),
    "ground to ground, rope 1 m": mission(1.0),
    "ground to ground, rope 5 m, a hook": mission(5.0, hook=(0.0, 0.0, 0.05), aside=0.9),
    "ground to ground, 10 kg": mission(5.0, **HEAVY, aside=1.0),
}

# No touch is harder, m/s.
SOFT = 0.6


def fly(plant, case, pilot, seconds, is_over=lambda: False):
    """The states at every period, and the greatest speeds at which payload and UAV came to the ground, m/s."""
    states, touch, before = [plant.state], [None, None], plant.state
    for index in range(round(seconds / case.period)):
        state = plant.step(*pilot(index * case.period, before))
        for body, velocity in enumerate((before.velocity, before.uav_velocity)):
            if state.on_ground[body] and not before.on_ground[body]:
                touch[body] = max(touch[body] or 0.0, float(velocity[2]))
        states.append(state)
        before = state
        if is_over():
            break
    plant.close()
    return states, touch


def missions(program, folder):
    """Each mission in both plants under the project's controller; how many went wrong."""
    wrong = 0
    for name, case in MISSIONS.items():
        touches, faults = [], []
        for plant in (Simulator(program, folder, case), MuJoCo(case)):
            pilot, modes, off = Pilot(program, folder, case), [], 0
            asked = case.mission[-1][0]

            def step(t, state):
                nonlocal off
                command = pilot(t, state)
                if not modes or modes[-1] != pilot.mode:
                    modes.append(pilot.mode)
                off += pilot.mode == "off"
                return command

            states, touch = fly(plant, case, step, asked + 40.0 + 4.0 * case.length, lambda: off * case.period > 1.0)
            pilot.close()
            touches.append(touch)
            end = states[-1]
            stands = end.on_ground == (True, True) and end.attitude[2, 2] > 0.99 and np.abs(end.uav_velocity).max() < 0.02
            flown = ["idle", "takeoff", "hold", "join", "follow", "hold", "land", "off"] if case.standing else ["land", "off"]
            if not (stands and modes == flown):
                faults.append(f"{type(plant).__name__} ends so: {modes}, {end}")
        for ours, theirs in zip(*touches):
            if not (ours and theirs and abs(ours - theirs) <= 0.2 * max(ours, theirs) and max(ours, theirs) <= SOFT):
                faults.append("touches differ or are hard")
        wrong += bool(faults)
        (load, uav), (load_there, uav_there) = touches
        print(
            f"{'DIFFERS' if faults else 'agrees'} {name}: payload {load} and {load_there} m/s, UAV {uav} and {uav_there} m/s "
            f"(bound 20 %, and {SOFT}) {'; '.join(faults)}",
            flush=True,
        )
    return wrong


def main(program):
    started, wrong = time.monotonic(), 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for name, (case, pilot, seconds, bound) in OPEN.items():
            ours, _ = fly(Simulator(program, folder, case), case, pilot, seconds)
            theirs, _ = fly(MuJoCo(case), case, pilot, seconds)
            apart = max(
                max(np.abs(a.position - b.position).max(), np.abs(a.uav_position - b.uav_position).max())
                for a, b in zip(ours, theirs)
            )
            way = max(np.abs(a.position - ours[0].position).max() for a in ours)
            wrong += not apart < bound
            print(f"{'agrees' if apart < bound else 'DIFFERS'} {name}: {apart:.1e} m apart (bound {bound:.0e}) over {way:.1f} m", flush=True)
        wrong += missions(program, folder)
    count = len(OPEN) + len(MISSIONS)
    print(f"{count} flights in both, {wrong} that differ, {time.monotonic() - started:.0f} s")
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) > 0)
