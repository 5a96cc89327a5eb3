"""What the page is checked against: reference vectors, random states, and the flow of the extended system."""

import json
import pathlib
import random

from arithmetic import Vec
from equations import Disturbance, Lift, State, Vehicle, bent, circle, ellipse, model

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE_I = Vehicle(0.5, 2.5, 0.03, 0.03, 0.05, 2.0, 9.81)
RANDOM = random.Random(1)


def golden(name):
    return json.loads((ROOT / f"tests/golden/{name}.json").read_text())


def numbers(n, size):
    return [RANDOM.uniform(-size, size) for _ in range(n)]


def random_x():
    """The paper's 16 coordinates: angles to ±0.6 rad, rates to 1 rad/s."""
    return numbers(3, 5.0) + numbers(5, 0.6) + numbers(3, 1.0) + numbers(5, 1.0)


def random_disturbance():
    return Disturbance(*(Vec(*numbers(3, 0.5)) for _ in range(4)), Vec(*numbers(3, 0.1)))


PATHS = {"circle": circle, "ellipse": ellipse, "bent": bent}


def each_vector(name):
    """Vehicle, state, and the rest, of each reference vector of a path."""
    data = golden(name)
    for vector in data["vectors"]:
        vehicle, x = Vehicle(*vector["par"]), State.of(vector["x"])
        yield data["meta"], vector, vehicle, x, lambda p, v=vector: PATHS[name](p, *v["path"])


def move(vehicle, x, zeta, u_zeta, torque, dist, t, steps):
    """The extended system (3.4), (3.5), (12.1) from (x, ζ) over t, u_ζ and τ held: Runge-Kutta of fourth order."""

    def add(state, k, h):
        x, zeta = state
        dx, dz = k
        axes = tuple(b + db * h for b, db in zip(x.b, dx.b))
        moved = State(
            x.p + dx.p * h, x.v + dx.v * h, x.q + dx.q * h, x.w + dx.w * h, axes, x.omega + dx.omega * h
        )
        return moved, [z + h * d for z, d in zip(zeta, dz)]

    def slope(state, s):
        x, zeta = state
        now = Disturbance(
            dist.d + dist.d_1 * s, dist.d_1, dist.delta + dist.delta_1 * s, dist.delta_1, dist.torque
        )
        thrust = Lift(vehicle, x, zeta, now).thrust
        v_dot, w_dot, o_dot, _ = model(vehicle, x, thrust, torque, now)
        (b1, b2, b3), (w1, w2, w3) = x.b, x.omega
        axes = (b2 * w3 - b3 * w2, b3 * w1 - b1 * w3, b1 * w2 - b2 * w1)
        return State(x.v, v_dot, x.w, w_dot, axes, o_dot), [zeta[1], zeta[2], zeta[3], u_zeta]

    state, h = (x, list(zeta)), t / steps
    for i in range(steps):
        s = i * h
        k1 = slope(state, s)
        k2 = slope(add(state, k1, h / 2), s + h / 2)
        k3 = slope(add(state, k2, h / 2), s + h / 2)
        k4 = slope(add(state, k3, h), s + h)
        for k, part in ((k1, 1), (k2, 2), (k3, 2), (k4, 1)):
            state = add(state, k, h * part / 6)
    return state
