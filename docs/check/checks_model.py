"""Sections 1 to 3: conventions, model, outputs and compensator."""

import math

from arithmetic import E3, NOTHING, Series, Vec, close, derivative
from coverage import covers
from equations import Answer, Lift, State, Vehicle, each, matvec, model, rotation
from reference import PATHS, RANDOM, TABLE_I, each_vector, golden, numbers, random_x


@covers("1.1", "1.2", "1.4")
def coordinates():
    for _ in range(20):
        alpha, beta, phi, theta, psi = numbers(5, 0.6)
        q = matvec(rotation(1, alpha), matvec(rotation(2, beta), E3))
        x = State.of([0, 0, 0, alpha, beta, phi, theta, psi] + numbers(8, 1.0))
        close(x.q, q, 1e-15, "(1.1)")
        b3 = Vec(math.sin(theta) * math.cos(phi), -math.sin(phi), math.cos(theta) * math.cos(phi))
        close(x.b[2], b3, 1e-15, "(1.2)")
        close((x.q.norm(), x.q.dot(x.w)), (1.0, 0.0), 1e-15, "(1.4), rod")
        for i, a in enumerate(x.b):
            close([a.dot(b) for b in x.b], [float(i == k) for k in range(3)], 1e-15, "(1.4), attitude")


@covers("1.3", "1.5")
def rates():
    for _ in range(20):
        phi, theta, psi = numbers(3, 0.6)
        w1, w2, w3 = omega = numbers(3, 1.0)
        s, c = math.sin(psi), math.cos(psi)
        phi_1, theta_1 = c * w1 - s * w2, (s * w1 + c * w2) / math.cos(phi)
        psi_1 = w3 + math.tan(phi) * (s * w1 + c * w2)

        def at(t):
            angles = [phi + phi_1 * t, theta + theta_1 * t, psi + psi_1 * t]
            axes = State.of([0, 0, 0, 0, 0] + angles + [0] * 8).b
            return [number for axis in axes for number in axis]

        b1, b2, b3 = State.of([0, 0, 0, 0, 0, phi, theta, psi] + [0] * 8).b
        expected = (*(b2 * w3 - b3 * w2), *(b3 * w1 - b1 * w3), *(b1 * w2 - b2 * w1))
        close(derivative(at), expected, 1e-10, "(1.5) by the rates of (1.3)")
        # And that ω is what these rates are in body axes: R takes ω to the axis of the turning.
        axis = matvec((b1, b2, b3), omega)
        close(axis.cross(b1), b2 * w3 - b3 * w2, 1e-14, "ω in body axes")


@covers("1.6", "2.1", "2.2", "2.3", "2.4", "2.6")
def newton():
    """The model gives each body what the forces on it say, and the rod its length."""
    for _ in range(20):
        x, thrust = State.of(random_x()), RANDOM.uniform(5.0, 60.0)
        car = TABLE_I
        v_dot, w_dot, _, lam = model(car, x, thrust, Vec(*numbers(3, 1.0)))
        uav = v_dot - w_dot * car.length
        close(v_dot * car.m_l, E3 * (car.m_l * car.g) + x.q * (car.m_l * lam), 1e-13, "payload")
        forces = E3 * (car.m_q * car.g) - x.b[2] * thrust - x.q * (car.m_l * lam)
        close(uav * car.m_q, forces, 1e-13, "UAV")
        close(w_dot.dot(x.q), -x.w.dot(x.w), 1e-13, "length")
    rest = State.of([0.0] * 16)
    car = TABLE_I
    lam = model(car, rest, car.m * car.g, NOTHING)[3]
    close((lam, -car.m_l * lam), (-car.g, car.m_l * car.g), 1e-14, "hover: tension is the payload's weight")


@covers("2.5", "2.7", "2.8")
def plant():
    """Against f and G of the reference."""
    for vector in golden("plant")["vectors"]:
        car, coordinates_, u = Vehicle(*vector["par"]), vector["x"], vector["u"]
        x = State.of(coordinates_)
        thrust, torque = u[0], Vec(*u[1:])
        alpha, beta, phi, theta, psi = coordinates_[3:8]
        alpha_1, beta_1 = coordinates_[11:13]
        sa, ca, sb, cb = math.sin(alpha), math.cos(alpha), math.sin(beta), math.cos(beta)
        m1, m2, b3 = Vec(cb, sa * sb, -ca * sb), Vec(0.0, ca, sa), x.b[2]
        k = thrust / (car.length * car.m_q)
        alpha_2 = 2 * sb / cb * alpha_1 * beta_1 - m2.dot(b3) * k / cb
        beta_2 = -sb * cb * alpha_1**2 + m1.dot(b3) * k
        close((alpha_2, beta_2), vector["xdot"][11:13], 1e-13, "(2.8)")
        along = b3.dot(x.q)
        turning = x.w.dot(x.w)
        close(turning, cb**2 * alpha_1**2 + beta_1**2, 1e-14, "|q̇|²")
        v_dot = E3 * car.g - x.q * (turning / car.c) - x.q * (along * thrust / car.m)
        w_dot = -x.q * turning + (b3 - x.q * along) * k
        o_dot = Vec(*(t / i for t, i in zip(each(car.j, x.omega).cross(x.omega) + torque, car.j)))
        close(v_dot, vector["xdot"][8:11], 1e-13, "(2.7), v̇")
        close(o_dot, vector["xdot"][13:16], 1e-13, "(2.5)")
        free = model(car, x, thrust, torque)
        close(w_dot, free[1], 1e-13, "(2.7), q̈")
        # The chart's accelerations make the same q̈.
        def rod(t):
            a, b = alpha + alpha_1 * t + alpha_2 * t * t / 2, beta + beta_1 * t + beta_2 * t * t / 2
            a1, b1 = alpha_1 + alpha_2 * t, beta_1 + beta_2 * t
            return list(State.of([0, 0, 0, a, b] + [0] * 6 + [a1, b1, 0, 0, 0]).w)

        close(derivative(rod), w_dot, 1e-9, "(2.8) against (2.7)")
        s, c, p1, p2 = math.sin(psi), math.cos(psi), x.omega[0], x.omega[1]
        angles = (c * p1 - s * p2, (s * p1 + c * p2) / math.cos(phi), x.omega[2] + math.tan(phi) * (s * p1 + c * p2))
        close(angles, vector["xdot"][5:8], 1e-13, "(1.3)")


@covers("3.1", "3.2", "3.3", "3.6", "3.7", "5.1", "5.2", "15.1", "15.7")
def outputs():
    """ξ against the reference, and that p⁽⁶⁾ enters as the page says: by a series with a sixth coefficient."""
    for name in PATHS:
        for _, vector, car, x, path in each_vector(name):
            answer = Answer(car, x, vector["zeta"], path, [[0.0] * 6, [0.0] * 6, [0.0] * 5, [0.0] * 2])
            close(answer.xi, vector["xi"], 1e-12, f"ξ of {name}")
            p6 = Vec(*numbers(3, 10.0))
            moved = path(Vec(*(Series.of([d[i] for d in answer.lift.p] + [p6[i]]) for i in range(3))))
            g1, g2 = answer.outputs.gradients
            expected = [b + g.dot(p6) for b, g in zip(answer.chi, (g1, g2, answer.outputs.rho))]
            close((moved.h1.at(6), moved.h2.at(6), moved.h3.at(5)), expected, 1e-9, f"(5.2) of {name}")
            if name != "circle":
                tangent = g1.cross(g2)
                close(answer.outputs.rho, tangent / tangent.norm(), 1e-13, "(3.2)")


@covers("3.4", "3.5")
def compensator():
    for name in PATHS:
        for _, vector, car, x, _ in each_vector(name):
            q3, along = x.q[2], x.q.dot(x.b[2])
            turning = x.w.dot(x.w)
            f11 = car.g - car.length * car.m_q / car.m * turning * q3
            thrust = car.m * (f11 - vector["zeta"][0]) / (q3 * along)
            close(thrust, vector["T"], 1e-13, "(3.5)")
            v_dot = model(car, x, thrust, NOTHING)[0]
            close(v_dot[2], vector["zeta"][0], 1e-12, "v̇3 = ζ1")
    hover = Lift(TABLE_I, State.of([0.0] * 16), [0.0] * 4)
    close(hover.thrust, TABLE_I.m * TABLE_I.g, 1e-14, "hover is ζ = 0")
