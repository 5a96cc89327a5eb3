"""The model and the law as sections 1 to 7 of the page, and (12.1) and (12.2), state them: slow and literal."""

import math

from arithmetic import E1, E2, E3, NOTHING, Series, Vec


class Vehicle:
    def __init__(self, m_l, m_q, j1, j2, j3, length, g):
        self.m_l, self.m_q, self.m = m_l, m_q, m_l + m_q
        self.j, self.length, self.g = Vec(j1, j2, j3), length, g
        self.c = self.m / (m_q * length)


def matvec(columns, v):
    return columns[0] * v[0] + columns[1] * v[1] + columns[2] * v[2]


def each(a, b):
    return Vec(*(x * y for x, y in zip(a, b)))


def rotation(axis, angle):
    """Columns of the rotation about a coordinate axis, 1 to 3."""
    s, c = math.sin(angle), math.cos(angle)
    return {
        1: (E1, Vec(0.0, c, s), Vec(0.0, -s, c)),
        2: (Vec(c, 0.0, -s), E2, Vec(s, 0.0, c)),
        3: (Vec(c, s, 0.0), Vec(-s, c, 0.0), E3),
    }[axis]


def product(a, b):
    return tuple(matvec(a, column) for column in b)


class State:
    """p, v, q, w = q̇, b1, b2, b3, ω."""

    def __init__(self, p, v, q, w, axes, omega):
        self.p, self.v, self.q, self.w, self.b, self.omega = p, v, q, w, axes, omega

    @classmethod
    def of(cls, x):
        """From the paper's 16 coordinates."""
        alpha, beta, phi, theta, psi = x[3:8]
        alpha_1, beta_1 = x[11:13]
        sa, ca, sb, cb = math.sin(alpha), math.cos(alpha), math.sin(beta), math.cos(beta)
        q = Vec(sb, -sa * cb, ca * cb)
        w = Vec(cb * beta_1, -ca * cb * alpha_1 + sa * sb * beta_1, -sa * cb * alpha_1 - ca * sb * beta_1)
        axes = product(rotation(2, theta), product(rotation(1, phi), rotation(3, psi)))
        return cls(Vec(*x[0:3]), Vec(*x[8:11]), q, w, axes, Vec(*x[13:16]))

    def b3_dot(self):
        return self.b[0] * self.omega[1] - self.b[1] * self.omega[0]


class Disturbance:
    def __init__(self, d=NOTHING, d_1=NOTHING, delta=NOTHING, delta_1=NOTHING, torque=NOTHING):
        self.d, self.d_1, self.delta, self.delta_1, self.torque = d, d_1, delta, delta_1, torque


def model(vehicle, x, thrust, torque, dist=Disturbance()):
    """(12.1) solved for v̇, q̈, ω̇; without disturbances (2.2) to (2.5)."""
    b3 = x.b[2]
    kappa = thrust / (vehicle.m_q * vehicle.length)
    lam = -(x.w.dot(x.w) + kappa * b3.dot(x.q) + dist.delta.dot(x.q)) / vehicle.c
    v_dot = E3 * vehicle.g + dist.d + x.q * lam
    w_dot = b3 * kappa + x.q * (vehicle.c * lam) + dist.delta
    j = vehicle.j
    total = each(j, x.omega).cross(x.omega) + torque + dist.torque
    return v_dot, w_dot, Vec(*(t / i for t, i in zip(total, j))), lam


class Lift:
    """(4.1) to (4.7), with the disturbances as (12.2) has them."""

    def __init__(self, vehicle, x, zeta, dist=Disturbance()):
        z1, z2, z3, z4 = zeta
        q, w, b3, b3_1, c = x.q, x.w, x.b[2], x.b3_dot(), vehicle.c
        self.l0 = (z1 - vehicle.g - dist.d[2]) / q[2]
        s0 = q * self.l0
        self.kappa = -(w.dot(w) + c * self.l0 + dist.delta.dot(q)) / b3.dot(q)
        self.q2 = b3 * self.kappa + s0 * c + dist.delta
        self.l1 = (z2 - dist.d_1[2] - self.l0 * w[2]) / q[2]
        s1 = q * self.l1 + w * self.l0
        swing = w.dot(self.q2 * 2.0 + dist.delta) + dist.delta_1.dot(q)
        self.kappa_1 = -(swing + c * self.l1 + self.kappa * (b3_1.dot(q) + b3.dot(w))) / b3.dot(q)
        self.q3 = b3 * self.kappa_1 + b3_1 * self.kappa + s1 * c + dist.delta_1
        self.l2 = (z3 - 2 * self.l1 * w[2] - self.l0 * self.q2[2]) / q[2]
        self.s2 = q * self.l2 + w * (2 * self.l1) + self.q2 * self.l0
        self.l3 = (z4 - 3 * (self.l2 * w[2] + self.l1 * self.q2[2]) - self.l0 * self.q3[2]) / q[2]
        s3 = q * self.l3 + (w * self.l2 + self.q2 * self.l1) * 3.0 + self.q3 * self.l0
        self.p = [x.p, x.v, E3 * vehicle.g + s0 + dist.d, s1 + dist.d_1, self.s2, s3]
        self.thrust = self.kappa * vehicle.m_q * vehicle.length

    def series(self):
        """(5.1)."""
        return Vec(*(Series.of([d[i] for d in self.p] + [0.0]) for i in range(3)))


def yaw_of(x):
    """(6.1): ψ, ψ̇, and the second row of R."""
    y, xx, z = (axis[1] for axis in x.b)
    n, square = xx * x.omega[1] + y * x.omega[0], xx * xx + y * y
    return math.atan2(y, xx), x.omega[2] - z * n / square, (y, xx, z)


def yaw_acceleration(x, o1, o2, psi_2):
    """(6.2), (6.3): ω̇3."""
    y, xx, z = (axis[1] for axis in x.b)
    w1, w2, w3 = x.omega
    y_1, x_1, z_1 = xx * w3 - z * w2, z * w1 - y * w3, y * w2 - xx * w1
    square = xx * xx + y * y
    n = (xx * w2 + y * w1) / square
    n_1 = x_1 * w2 + y_1 * w1 + xx * o2 + y * o1
    return psi_2 + z_1 * n + z * (n_1 + 2 * z * z_1 * n) / square


def lower(vehicle, x, lift, p6, psi_2, dist=Disturbance()):
    """(7.1) to (7.5): the torque."""
    q, w, omega = x.q, x.w, x.omega
    a = p6 - w * (4 * lift.l3) - lift.q2 * (6 * lift.l2) - lift.q3 * (4 * lift.l1)
    l4 = q.dot(a) + lift.l0 * (4 * w.dot(lift.q3) + 3 * lift.q2.dot(lift.q2))
    q4 = (a - q * l4) / lift.l0
    f = q4 - lift.s2 * vehicle.c
    b1, b2, _ = x.b
    o1 = omega[1] * omega[2] - (b2.dot(f) + 2 * lift.kappa_1 * omega[0]) / lift.kappa
    o2 = (b1.dot(f) - 2 * lift.kappa_1 * omega[1]) / lift.kappa - omega[0] * omega[2]
    o3 = yaw_acceleration(x, o1, o2, psi_2)
    j = vehicle.j
    return each(j, Vec(o1, o2, o3)) + omega.cross(each(j, omega)) - dist.torque


class Outputs:
    """Of a path: h1, h2, h3, ψ_d as series, and ∇h1, ∇h2, ρ now."""

    def __init__(self, h1, h2, along, speed, yaw, gradients, p):
        self.h1, self.h2, self.yaw, self.gradients = h1, h2, yaw, gradients
        length = along.dot(along).sqrt()
        velocity = Vec(*(series.diff() for series in p))
        self.h3 = along.dot(velocity) / length - speed
        self.rho = Vec(*(a.c[0] for a in along / length))


def circle(p, d1, d2, vd):
    """(15.7)."""
    x, y, z = p
    now = Vec(*(s.c[0] for s in p))
    along = Vec(-y, x, z * 0.0)
    gradients = (Vec(2 * now[0], 2 * now[1], 0.0), E3)
    return Outputs(x * x + y * y - d1 * d1, z - d2, along, vd, z * 0.0, gradients, p)


def draped(p, f, f_gradient, height, slope, speed, yaw):
    """(15.1); `yaw` of None is along the tangent."""
    f1, f2 = f_gradient
    along = Vec(f2, -f1, slope * f2)
    g1, g2, s = f1.c[0], f2.c[0], slope.c[0]
    if yaw is None:
        yaw = along[1].atan2(along[0])
    return Outputs(f, p[2] - height, along, speed, yaw, (Vec(g1, g2, 0.0), Vec(-s, 0.0, 1.0)), p)


def ellipse(p, a, b, c0, c1, vd):
    x, y, _ = p
    f = x * x * (1 / a**2) + y * y * (1 / b**2) - 1.0
    slope = x * 0.0 + c1
    return draped(p, f, (x * (2 / a**2), y * (2 / b**2)), x * c1 + c0, slope, vd, None)


def bent(p, a, b, c0, v0, v1):
    x, y, _ = p
    f = x**4 * (1 / a**4) + y**4 * (1 / b**4) - 1.0
    s, c = (x * 0.5).sin()
    gradient = (x**3 * (4 / a**4), y**3 * (4 / b**4))
    return draped(p, f, gradient, s * 0.5 + c0, c * 0.25, x * (v1 / a) + v0, x * 0.2)


def solve(outputs, right):
    """(5.6), and Δ."""
    g1, g2 = outputs.gradients
    rho = outputs.rho
    delta = g1.cross(g2).dot(rho)
    y1, y2, y3 = right
    return (g2.cross(rho) * y1 + rho.cross(g1) * y2 + g1.cross(g2) * y3) / delta, delta


class Answer:
    """The law: ξ, χ, ν, T, u_ζ, τ."""

    def __init__(self, vehicle, x, zeta, path, gains, integral=(0.0, 0.0, 0.0), k_integral=(0.0, 0.0, 0.0)):
        self.lift = Lift(vehicle, x, zeta)
        self.outputs = path(self.lift.series())
        h1, h2, h3, psi_d = (getattr(self.outputs, name) for name in ("h1", "h2", "h3", "yaw"))
        psi, psi_1, _ = yaw_of(x)
        rows = [
            [h1.at(k) for k in range(6)],
            [h2.at(k) for k in range(6)],
            [h3.at(k) for k in range(5)],
            [math.remainder(psi - psi_d.at(0), math.tau), psi_1 - psi_d.at(1)],
        ]
        self.xi = [number for row in rows for number in row]
        self.chi = [h1.at(6), h2.at(6), h3.at(5)]
        # (5.3), (5.4)
        self.nu = [-sum(k * h for k, h in zip(k_row, row)) for k_row, row in zip(gains, rows)]
        for i in range(3):
            self.nu[i] -= k_integral[i] * integral[i]
        p6, self.delta = solve(self.outputs, [n - b for n, b in zip(self.nu, self.chi)])
        # (5.7), (5.8)
        self.psi_2 = self.nu[3] + psi_d.at(2)
        self.p6, self.u_zeta = p6, p6[2]
        self.torque = lower(vehicle, x, self.lift, p6, self.psi_2)
