"""Section 17: the payload filter and the navigation filter."""

import math

from arithmetic import E3, NOTHING, Vec, close, derivative
from coverage import covers
from equations import State, matvec, model
from reference import RANDOM, TABLE_I, numbers, random_x


def in_body(x, v):
    """Rᵀ v."""
    return Vec(*(axis.dot(v) for axis in x.b))


@covers("17.1", "17.2", "17.3")
def pendulum():
    """Against the model, whose accelerometer is at the UAV."""
    car = TABLE_I
    for _ in range(20):
        x, thrust = State.of(random_x()), RANDOM.uniform(10.0, 50.0)
        v_dot, w_dot, _, lam = model(car, x, thrust, NOTHING)
        f = v_dot - w_dot * car.length - E3 * car.g
        u = -f
        s = x.q.dot(u) + car.length * x.w.dot(x.w)
        close(s, -lam, 1e-12, "s = tension/m_L")
        close((u - x.q * s) / car.length, w_dot, 1e-12, "(17.2)")
        model_of_thrust = E3 * -thrust + in_body(x, x.q * (car.m_l * s))
        close(in_body(x, f) * car.m_q, model_of_thrust, 1e-12, "(17.3)")


def on_sphere(q_h, w_h):
    """q and q̇ of their horizontal components."""
    q3 = math.sqrt(1 - q_h[0] ** 2 - q_h[1] ** 2)
    q = Vec(q_h[0], q_h[1], q3)
    return q, Vec(w_h[0], w_h[1], -(q_h[0] * w_h[0] + q_h[1] * w_h[1]) / q3)


def swing(q, w, u, length):
    """(17.2)."""
    s = q.dot(u) + length * w.dot(w)
    return s, (u - q * s) / length


@covers("17.4", "17.5", "17.6", "17.7")
def errors():
    """By differences of the equations that they come from."""
    car = TABLE_I
    for _ in range(10):
        q_h, w_h, eta, zeta, du_h = numbers(2, 0.5), numbers(2, 1.0), numbers(2, 1.0), numbers(2, 1.0), numbers(3, 1.0)
        u, du, x = Vec(*numbers(3, 3.0)) - E3 * 9.0, Vec(*du_h), State.of(random_x())
        moved = lambda t: on_sphere([a + t * b for a, b in zip(q_h, eta)], [a + t * b for a, b in zip(w_h, zeta)])  # noqa: E731
        q, w = moved(0.0)
        b3 = [-q[0] / q[2], -q[1] / q[2]]
        d_q = Vec(eta[0], eta[1], b3[0] * eta[0] + b3[1] * eta[1])
        third = b3[0] * zeta[0] + b3[1] * zeta[1]
        third -= sum((w_h[i] + w[2] * b3[i]) * eta[i] for i in range(2)) / q[2]
        d_w = Vec(zeta[0], zeta[1], third)
        close(derivative(lambda t: moved(t)[0]), d_q, 1e-9, "(17.4)")
        close(derivative(lambda t: moved(t)[1]), d_w, 1e-9, "(17.5)")
        s, _ = swing(q, w, u, car.length)
        d_s = u.dot(d_q) + q.dot(du) + 2 * car.length * w.dot(d_w)
        close(derivative(lambda t: swing(*moved(t), u + du * t, car.length)[0]), d_s, 1e-8, "δs")
        rate = derivative(lambda t: swing(*moved(t), u + du * t, car.length)[1])
        close(rate[:2], [(du[i] - q[i] * d_s - s * eta[i]) / car.length for i in range(2)], 1e-8, "(17.6)")
        for axis in x.b:
            seen = lambda t: car.m_l / car.m_q * axis.dot(moved(t)[0]) * swing(*moved(t), u, car.length)[0]  # noqa: E731, B023
            alone = u.dot(d_q) + 2 * car.length * w.dot(d_w)
            expected = car.m_l * (axis.dot(q) * alone + s * axis.dot(d_q)) / car.m_q
            close(derivative(seen), expected, 1e-8, "(17.7), the rod's part")
    # The correlation, in steps of white noise n: the rod's rate is off by ∫ (1 − q qᵀ) n/L, the mean of z_i by its own.
    axis, q, density, window, steps, flights = Vec(0.6, 0.0, 0.8), Vec(0.0, 0.28, 0.96), 0.3, 0.04, 10, 40000
    size, sums = density / math.sqrt(window / steps), [0.0, 0.0]
    for _ in range(flights):
        total = NOTHING
        for _ in range(steps):
            total = total + Vec(*(RANDOM.gauss(0.0, size) for _ in range(3)))
        off = (total - q * q.dot(total)) * (window / steps / car.length)
        mean = axis.dot(total) / steps
        sums = [a + off[i] * mean for i, a in enumerate(sums)]
    expected = (axis - q * q.dot(axis)) * (density**2 / car.length)
    # Five standard errors of a mean product.
    spread = 5 * density**2 / car.length / math.sqrt(flights)
    for i in range(2):
        assert abs(sums[i] / flights - expected[i]) < spread, "(17.7), the correlation"


@covers("17.8", "17.9", "17.11")
def late():
    """A sample τ old of a motion at constant acceleration."""
    p, v, a, tau = Vec(*numbers(3, 1.0)), Vec(*numbers(3, 1.0)), Vec(*numbers(3, 1.0)), 0.15
    at = lambda t, p, v, a: p + v * t + a * (t * t / 2)  # noqa: E731
    d_p, d_v, d_a = (Vec(*numbers(3, 0.1)) for _ in range(3))
    then = p - v * tau + a * (tau * tau / 2)
    close(then, at(-tau, p, v, a), 1e-15, "the nominal place of then")
    moved = at(-tau, p + d_p, v + d_v, a + d_a) - then
    close(moved, d_p - d_v * tau + d_a * (tau * tau / 2), 1e-14, "(17.11); without Δa, (17.8)")
    close((v + d_v - (a + d_a) * tau) - (v - a * tau), d_v - d_a * tau, 1e-14, "(17.11); without Δa, (17.9)")


def turned(axes, theta):
    """Exp(theta) R, to second order in a small theta."""
    return tuple(axis + theta.cross(axis) + theta.cross(theta.cross(axis)) * 0.5 for axis in axes)


@covers("17.10", "17.12", "17.13", "17.14")
def navigation():
    for _ in range(10):
        x = State.of(random_x())
        theta, bias, f_b, r, omega = (Vec(*numbers(3, 1.0)) for _ in range(5))
        # R = Exp(δθ) R̂: the true attitude is turned by δθ from the estimate; the biases are what the sensors show too much.
        force = lambda t: matvec(turned(x.b, theta * t), f_b - bias * t)  # noqa: E731
        f = matvec(x.b, f_b)
        close(derivative(force), -f.cross(theta) - matvec(x.b, bias), 1e-9, "(17.10), δv̇")
        place = lambda t: matvec(turned(x.b, theta * t), r)  # noqa: E731
        close(derivative(place), -matvec(x.b, r).cross(theta), 1e-9, "(17.12), the lever")
        speed = lambda t: matvec(turned(x.b, theta * t), omega.cross(r))  # noqa: E731
        close(derivative(speed), -matvec(x.b, omega.cross(r)).cross(theta), 1e-9, "(17.13), the lever")
        # The late part of both is (17.11) with δ for Δ.
        b1 = x.b[0]
        heading = lambda t: math.atan2(turned(x.b, theta * t)[0][1], turned(x.b, theta * t)[0][0])  # noqa: E731
        level = b1[0] ** 2 + b1[1] ** 2
        expected = theta[2] - b1[2] * (b1[0] * theta[0] + b1[1] * theta[1]) / level
        close(derivative(heading), expected, 1e-8, "(17.14)")
        # The attitude's own error grows as its bias turns it: R̂' = R̂ [ω + b]×, R' = R [ω]×.
        h = 1e-4
        step = lambda axes, rate: turned(axes, matvec(axes, rate) * h)  # noqa: E731
        true, estimate = step(x.b, omega), step(x.b, omega + bias)
        spin = sum((t.cross(e) * -0.5 for t, e in zip(true, estimate)), NOTHING)
        close(spin / h, -matvec(x.b, bias), 1e-3, "(17.10), δθ̇")
