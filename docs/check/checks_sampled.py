"""Sections 11 and 12: the sampled law and its observers."""

import math

from arithmetic import NOTHING, Vec, close, place, roots
from coverage import covers
from equations import Answer, Disturbance, Lift, State, Vehicle, circle, model
from reference import TABLE_I, golden, numbers, random_x


def predict(car, x, thrust, torque, h):
    """(11.2), (11.3)."""
    v_dot, w_dot, o_dot, _ = model(car, x, thrust, torque)
    q, w = x.q + x.w * h + w_dot * (h * h / 2), x.w + w_dot * h
    w = w - q * q.dot(w)
    t1, t2, t3 = x.omega * h + o_dot * (h * h / 2)
    b1, b2, b3 = x.b
    axes = (b1 + b2 * t3 - b3 * t2, b2 + b3 * t1 - b1 * t3, b3 + b1 * t2 - b2 * t1)
    return State(x.p + x.v * h + v_dot * (h * h / 2), x.v + v_dot * h, q, w, axes, x.omega + o_dot * h)


def chain(zeta, u, t):
    """(11.4)."""
    z = list(zeta) + [u]
    return [sum(z[i + k] * t**k / math.factorial(k) for k in range(5 - i)) for i in range(4)]


def held(h, ahead, duration=0.6):
    """A sampled closed loop on Table I's circle, thrust and torque held: where it is at the end."""
    car, gains_ = TABLE_I, golden("circle")["meta"]["gains_fig56"]
    path = lambda p: circle(p, 5.0, -10.0, 1.0)  # noqa: E731
    x, zeta, u = State.of([5.4, 0.0, -9.8] + [0.05, -0.05, 0.02, 0.03, 0.1] + [0.0, 0.6] + [0.0] * 6), [0.0] * 4, 0.0
    thrust, torque = car.m * car.g, NOTHING
    for _ in range(round(duration / h)):
        at, z = (predict(car, x, thrust, torque, h / 2), chain(zeta, 0.0, 0.0)) if ahead else (x, zeta)
        if ahead:
            z = chain(zeta, u, h / 2)
        answer = Answer(car, at, z, path, gains_)
        thrust, torque, u = answer.lift.thrust, answer.torque, answer.u_zeta
        zeta = chain(zeta, u, h)
        steps = 4
        for _ in range(steps):
            x = rigid(car, x, thrust, torque, h / steps)
    return x


def rigid(car, x, thrust, torque, h):
    """One Runge-Kutta step of (2.2) to (2.5) under a held command."""

    def slope(x):
        v_dot, w_dot, o_dot, _ = model(car, x, thrust, torque)
        (b1, b2, b3), (w1, w2, w3) = x.b, x.omega
        return x.v, v_dot, x.w, w_dot, (b2 * w3 - b3 * w2, b3 * w1 - b1 * w3, b1 * w2 - b2 * w1), o_dot

    def add(x, k, h):
        p, v, q, w, b, o = k
        axes = tuple(a + d * h for a, d in zip(x.b, b))
        return State(x.p + p * h, x.v + v * h, x.q + q * h, x.w + w * h, axes, x.omega + o * h)

    k1 = slope(x)
    k2 = slope(add(x, k1, h / 2))
    k3 = slope(add(x, k2, h / 2))
    k4 = slope(add(x, k3, h))
    for k, part in ((k1, 1), (k2, 2), (k3, 2), (k4, 1)):
        x = add(x, k, h * part / 6)
    return x


@covers("11.1", "11.2", "11.3", "11.4")
def sampling():
    """Half the period, half the error without the look-ahead, and a quarter with it."""
    zeta, u, t = numbers(4, 1.0), 0.7, 0.3
    fine = list(zeta)
    for _ in range(30000):
        # The chain by its midpoint rule.
        d = t / 30000
        mid = [z + d / 2 * n for z, n in zip(fine, fine[1:] + [u])]
        fine = [z + d * n for z, n in zip(fine, mid[1:] + [u])]
    close(chain(zeta, u, t), fine, 1e-9, "(11.4)")
    exact = held(0.002, True).p
    off = lambda h, ahead: (held(h, ahead).p - exact).norm()  # noqa: E731
    ratios = [off(0.04, ahead) / off(0.02, ahead) for ahead in (False, True)]
    assert 1.7 < ratios[0] < 2.4, f"first order: {ratios}"
    assert 3.4 < ratios[1] < 4.8, f"second order: {ratios}"


@covers("11.5", "11.6", "11.7", "11.8")
def sampled():
    # (11.5): what the integral gains by the middle of the hold, for an output that moves, to within its second order.
    output, rate, period, k_integral, k0, integral = 0.7, -0.4, 0.004, 3.0, 2.0, 0.2
    later = integral + output * period / 2 + rate * (period / 2) ** 2 / 2
    raised = (k0 + k_integral * period / 2) * output + k_integral * integral
    left_out = k_integral * abs(rate) * (period / 2) ** 2 / 2
    assert abs(raised - (k0 * output + k_integral * later)) <= left_out * 1.001, "(11.5)"
    # (11.6) is the exact solution of a lag over a period.
    lag, applied, wanted, u = 0.05, 20.0, 31.0, 20.0
    for _ in range(100000):
        u += (wanted - u) / lag * (0.01 / 100000)
    close(wanted + (applied - wanted) * math.exp(-0.01 / lag), u, 1e-6, "(11.6)")
    car = TABLE_I
    for _ in range(20):
        x, zeta, dist = State.of(random_x()), numbers(4, 2.0), Disturbance(Vec(*numbers(3, 0.5)))
        thrust = Lift(car, x, zeta, dist).thrust
        applied = thrust - 4.0
        corrected = zeta[0] + (thrust - applied) * x.q[2] * x.q.dot(x.b[2]) / car.m
        close(model(car, x, applied, NOTHING, dist)[0][2], corrected, 1e-12, "(11.7)")
        lam = -(x.w.dot(x.w) + applied * x.b[2].dot(x.q) / (car.m_q * car.length)) / car.c
        continued = [car.g + dist.d[2] + lam * x.q[2], 0.0, 0.0, 0.0]
        close(Lift(car, x, continued, dist).thrust, applied, 1e-12, "(11.8)")


def characteristic(matrix):
    """Of a 3×3 or 2×2 matrix: coefficients below the leading one, low order first."""
    n = len(matrix)
    trace = sum(matrix[i][i] for i in range(n))
    if n == 2:
        (a, b), (c, d) = matrix
        return [a * d - b * c, -trace]
    (a, b, c), (d, e, f), (g, h, i) = matrix
    minors = a * e - b * d + a * i - c * g + e * i - f * h
    return [-(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)), minors, -trace]


@covers("12.3", "12.4", "12.5")
def observers():
    """The sampled error dynamics, simulated from unit errors; their poles, and no lag behind a force that grows."""
    o, h = 8.0, 0.002
    a = math.exp(-o * h)
    by_gains = {
        3: (1 - a**3, 1.5 * (1 - a) ** 2 * (1 + a) / h, (1 - a) ** 3 / h**2),
        2: (1 - a**2, (1 - a) ** 2 / h, 0.0),
    }
    for n, (g1, g2, g3) in by_gains.items():

        def step(error, force=0.0):
            velocity, d, rate = (list(error) + [0.0])[:3]
            rate_next = rate - g3 * velocity
            d_next = d - g2 * velocity + h * rate_next
            # The trapezoid from the estimate before its correction to the one after it.
            return [(1 - g1) * velocity + h / 2 * (d + d_next), d_next, rate_next][:n]

        columns = [step([float(i == k) for i in range(n)]) for k in range(n)]
        found = characteristic([[columns[k][i] for k in range(n)] for i in range(n)])
        if n == 3:
            side = 0.75 * (1 - a) ** 2 * (1 + a)
            expected = [-(a**3) - side, 3 * a * a + 2 * side, -3 * a - side]
        else:
            side = 0.5 * (1 - a) ** 2
            expected = [a * a + side, -2 * a - side]
        close(found, expected, 1e-12, f"(12.5), {n} states")
        away = max(abs(root - a) for root in roots(found))
        assert away < 0.005, f"poles {away} from a"
        # In continuous time: (s + o)ⁿ.
        k = place([-o] * n)
        close(k, {3: [o**3, 3 * o * o, 3 * o], 2: [o * o, 2 * o]}[n], 1e-14, "(12.3)")
        # A steady rate of three states leaves nothing: the error's equations are homogeneous in it.
        error = [0.3, 1.0, 2.0][:n]
        for _ in range(2500):
            error = step(error)
        close(error, [0.0] * n, 1e-9, "it converges")


@covers("11.9")
def lead():
    """A lag under a led command is the shorter lag under the command itself."""
    for lag in (0.02, 0.05, 0.1, 0.3):
        short = min(lag, max(lag / 5, 0.01))
        led, plain, wanted, h = 4.0, 4.0, 9.0, 1e-5
        for _ in range(int(0.05 / h)):
            led += (led + (wanted - led) * lag / short - led) / lag * h
            plain += (wanted - plain) / short * h
        close(led, plain, 1e-9, f"(11.9), {lag} s")


@covers("11.10", "11.11")
def through_flight():
    """Through 25 commands of 2 ms in 8 steps, and carried a period at a time: second order in the step's length."""
    car = TABLE_I
    x = State.of([5.4, 0.0, -9.8] + [0.05, -0.05, 0.02, 0.03, 0.1] + [0.0, 0.6] + [0.0] * 6)
    h, count = 0.002, 24
    commands = [(car.m * car.g + 0.5 * math.sin(0.3 * i), Vec(0.02 * math.cos(i / 5), -0.03, 0.01)) for i in range(count)]
    exact = x
    for thrust, torque in commands:
        for _ in range(4):
            exact = rigid(car, exact, thrust, torque, h / 4)

    def steps(n):
        at, size = x, count // n
        for i in range(n):
            part = commands[i * size : (i + 1) * size]
            thrust = sum(t for t, _ in part) / size
            torque = Vec(*(sum(tau[k] for _, tau in part) / size for k in range(3)))
            at = predict(car, at, thrust, torque, size * h)
            q = at.q * (1 / at.q.norm())
            at = State(at.p, at.v, q, at.w - q * q.dot(at.w), at.b, at.omega)
        return [(at.p - exact.p).norm(), (at.q - exact.q).norm(), (at.b[2] - exact.b[2]).norm()]

    one, eight, each = steps(1), steps(8), steps(count)
    # The rod's error is small whatever the steps: its acceleration hardly changes.
    assert all(each[i] < eight[i] < one[i] for i in (0, 2)), f"(11.10), (11.11): {one} {eight} {each}"
    assert max(eight) < 2e-6, f"(11.10): {eight}"


@covers("12.9")
def behind():
    """The error of a force that grows with its rate, found and expected over a latency, as without one."""

    def left(o, latency, s=1e-3):
        y, x = o * latency, s / o
        return (1 - math.exp(-s * latency) * (1 + (3 + y) * x) / (1 + x) ** 3) / s**2

    for o, latency in ((8.0, 0.02), (8.0, 0.06), (4.0, 0.1), (2.0, 0.0)):
        y = o * latency
        close(left(o, latency), (3 + 3 * y + y * y / 2) / o**2, 1e-3, "(12.9)")
        faster = o * (y / 2 + math.sqrt(1 + y * y / 12)) / (1 - y * y / 6)
        close(left(faster, latency), 3 / o**2, 1e-3, "(12.9)")


@covers("12.8")
def bounce():
    """The frequency at which two bodies on a spring part and meet, from their equations."""
    m_l, m_q, k = 0.5, 2.5, 98.1 / 2.0
    omega = math.sqrt(k * (1 / m_l + 1 / m_q))
    stretch, parting, h = 0.01, 0.0, 1e-5
    for _ in range(int(2 * math.pi / omega / h)):
        parting += -k * stretch * (1 / m_l + 1 / m_q) * h
        stretch += parting * h
    close(stretch, 0.01, 1e-6, "(12.8)")


@covers("12.7")
def weighed():
    """The share that a wrong mass implies in any motion, and a wrong thrust where the rod does not turn."""
    car = TABLE_I
    for mass, scale in ((1.5, 1.0), (0.2, 1.0), (0.5, 1.2), (0.5, 0.85)):
        real = Vehicle(mass, car.m_q, *car.j, car.length, car.g)
        for _ in range(5):
            x = State.of(random_x())
            if scale != 1.0:
                x = State(x.p, x.v, x.q, NOTHING, x.b, x.omega)
            thrust = real.m * real.g
            v_dot, _, _, _ = model(real, x, thrust * scale, NOTHING)
            told, _, _, lam = model(car, x, thrust, NOTHING)
            share = lam / (lam + (v_dot - told).dot(x.q))
            close(share, real.m / car.m / scale, 1e-12, "(12.7)")


@covers("12.6")
def implied_mass():
    """A payload of 0.8 kg where 0.5 is told, hanging at rest: d is what the told model lacks."""
    car = TABLE_I
    real = Vehicle(0.8, car.m_q, *car.j, car.length, car.g)
    thrust = real.m * real.g
    x = State.of([0.0] * 16)
    v_dot, _, _, lam = model(car, x, thrust, NOTHING)
    d = -v_dot
    close(car.m * lam / (lam + d.dot(x.q)), real.m, 1e-13, "(12.6)")
