"""Flies the same cases in the simulator and in MuJoCo, and holds them to each other.

    python flights.py target/release/hil-sim

Commands are open loop in all but the landings: what differs there grows with nothing that corrects it. Ends with status 0 if every
flight agrees within its bound.
"""

import math
import pathlib
import sys
import tempfile
import time

import numpy as np

from plants import GRAVITY, Case, MuJoCo, Simulator

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


class Lander:
    """Sinks level at 0.5 m/s; once the payload stands, goes 0.6 m aside. Exact states, PD on the UAV, the cable's pull fed forward."""

    def __init__(self, case):
        self.case, self.touched, self.off = case, None, False
        self.pull, self.wanted = 0.0, np.array(case.uav_position, dtype=float)

    def __call__(self, t, state):
        case = self.case
        if state.on_ground[1]:
            self.off = True
        if self.off:
            return 0.0, (0.0, 0.0, 0.0)
        if state.on_ground[0] and self.touched is None:
            self.touched = t
        self.wanted[2] += 0.5 * case.period
        rate = np.array((0.0, 0.0, 0.5))
        if self.touched is not None and t > self.touched + 0.5:
            self.wanted[0] = min(self.wanted[0] + 0.5 * case.period, 0.6)
        # The pull of a payload that hangs; once it stands, gone over a tenth of a second.
        hangs = 0.0 if state.on_ground[0] else case.payload_mass * GRAVITY
        self.pull += (hangs - self.pull) * min(1.0, 10.0 * case.period) if t > 0.0 else hangs
        error, late = state.uav_position - self.wanted, state.uav_velocity - rate
        wanted = np.clip(0.8 * error + 2.0 * late, -2.0, 2.0)
        force = case.uav_mass * (np.array((0.0, 0.0, GRAVITY)) + wanted) + np.array((0.0, 0.0, self.pull))
        body = state.attitude.T @ force
        tilt = np.array((-body[1], body[0], 0.0)) / np.linalg.norm(force)
        torque = np.array(case.inertia) * (64.0 * tilt - 16.0 * state.body_rate)
        return max(body[2], 0.0), torque


def landing(length, payload_mass=0.5, uav_mass=2.5, inertia=(0.03, 0.03, 0.05), **what):
    height = 1.0
    return Case(
        length=length,
        payload_mass=payload_mass,
        uav_mass=uav_mass,
        inertia=inertia,
        ground=True,
        position=(0.0, 0.0, -height - 0.05),
        uav_position=(0.0, 0.0, -height - 0.05 - length),
        period=0.004,
        step=5e-4,
        **what,
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

LANDINGS = {
    "landing, rope 0.5 m": landing(0.5),
    "landing, rope 2 m": landing(2.0),
    "landing, rope 5 m": landing(5.0),
    "landing, rope 15 m": landing(15.0),
    "landing, 10 kg under 25 kg": landing(10.0, 10.0, 25.0, (1.0, 1.0, 1.8), feet_apart=0.5),
    "landing, 0.1 kg": landing(2.0, 0.1),
}


def fly(plant, case, pilot, seconds):
    """The states at every period, and the speeds at which payload and UAV first touch the ground, m/s."""
    states, touch, before = [plant.state], [None, None], plant.state
    for index in range(round(seconds / case.period)):
        state = plant.step(*pilot(index * case.period, before))
        for body, velocity in enumerate((before.velocity, before.uav_velocity)):
            if state.on_ground[body] and touch[body] is None:
                touch[body] = float(velocity[2])
        states.append(state)
        before = state
    plant.close()
    return states, touch


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
        for name, case in LANDINGS.items():
            speeds = []
            for plant in (Simulator(program, folder, case), MuJoCo(case)):
                states, touch = fly(plant, case, Lander(case), 4.0 + case.length / 0.4)
                speeds.append(touch)
                end = states[-1]
                stands = end.on_ground == (True, True) and end.attitude[2, 2] > 0.99 and np.abs(end.uav_velocity).max() < 0.02
                if not stands:
                    wrong += 1
                    print(f"DIFFERS {name}: {type(plant).__name__} does not stand in the end: {end}")
            (load, uav), (load_there, uav_there) = speeds
            close = all(a and b and abs(a - b) <= 0.2 * max(a, b) for a, b in zip(*speeds))
            wrong += not close
            print(
                f"{'agrees' if close else 'DIFFERS'} {name}: payload {load} and {load_there} m/s, "
                f"UAV {uav} and {uav_there} m/s (bound 20 %)",
                flush=True,
            )
    count = len(OPEN) + len(LANDINGS)
    print(f"{count} flights in both, {wrong} that differ, {time.monotonic() - started:.0f} s")
    return wrong


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) > 0)
