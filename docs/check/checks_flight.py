"""Sections 13 to 16: approach, hold, curves, rotors."""

import math

from arithmetic import E1, E2, E3, NOTHING, Series, Vec, close, derivative, roots
from coverage import covers
from equations import Disturbance, State, model
from reference import RANDOM, TABLE_I, numbers, random_x


def profile(x):
    """S of (13.2) by its integral, Simpson's rule."""
    n = 2000
    f = lambda y: 12012 * y**6 * (1 - y) ** 6  # noqa: E731
    h = (1 - x) / n
    return h / 3 * sum(f(x + i * h) * (1 if i in (0, n) else 4 if i % 2 else 2) for i in range(n + 1))


@covers("13.1", "13.2", "13.3", "13.4", "13.8")
def slide():
    close((profile(0.0), profile(1.0)), (1.0, 0.0), 1e-12, "S from 1 to 0")
    rate = 0.4
    for x in [0.1 * i for i in range(1, 10)]:
        y = 1 - x
        value = y**7 * sum(math.comb(6 + j, j) * x**j for j in range(7))
        close(value, profile(x), 1e-12, "S₀")
        s = [value, -12012 * (x * y) ** 6 * rate]
        x1, x2 = rate * (1 - 2 * x) / (x * y), -(rate**2) / (x * y)
        for k in range(2, 7):
            s.append((8 - k) / k * x1 * s[k - 1] + (15 - k) * (k - 2) / (k * (k - 1)) * x2 * s[k - 2])
        # S′ is a polynomial in x: its Taylor coefficients about x are exact in series arithmetic.
        moving = Series([x, rate] + [0.0] * 4)
        slope = (moving * (1.0 - moving)) ** 6 * (-12012.0 * rate)
        close(s[1:], [c / (k + 1) for k, c in enumerate(slope.c)], 1e-12, "(13.3)")
        n = 400
        area = (1 - x) / n * (0.5 * profile(x) + sum(profile(x + (1 - x) * i / n) for i in range(1, n)))
        close((0.5 - x) * value + 858 * (x * y) ** 7, area, 1e-5, "(13.4)")
    peaks = [0.0] * 4
    for i in range(1, 2000):
        moving = Series([i / 2000, 1.0, 0.0, 0.0])
        slope = (moving * (1.0 - moving)) ** 6 * 12012.0
        peaks = [max(p, abs(slope.at(k))) for k, p in enumerate(peaks)]
    close(peaks, (2.9326, 13.177, 140.77, 1341.1), 2e-4, "(13.8)")
    # (13.1): at the start the displacement is D and moves with V; E is −∫S from t to T_b.
    braking, start, velocity = 3.0, 0.7, -1.3

    def at(t):
        x = t / braking
        area = (0.5 - x) * profile(x) + 858 * (x * (1 - x)) ** 7
        return start + velocity * braking / 2 - velocity * braking * area

    close(at(0.0), start, 1e-12, "D")
    close((at(1e-5) - at(0.0)) / 1e-5, velocity, 1e-4, "V")


@covers("13.5", "13.6", "13.7")
def pace():
    """The lean that a payload's motion takes, against the model's inverse by force balance on either body."""
    car = TABLE_I
    for _ in range(50):
        size = RANDOM.uniform(0.2, 2.0)
        a, snap = Vec(*numbers(3, 1.0)), Vec(*numbers(2, 0.02), 0.0)
        a = a * (size / a.norm())
        # The rod is along g e3 − p̈ upwards; its second derivative is that of the unit vector.
        pull = E3 * car.g - a
        q = pull / pull.norm()
        lean = math.acos(q[2])
        assert math.tan(lean) <= size / (car.g - size) + 1e-12, "rod"
        turned = -(snap - q * q.dot(snap)) / pull.norm()
        exact = (pull * car.m) + turned * (car.m_q * car.length)
        linear = (E3 * car.g - a - snap * (car.m_q * car.length / (car.m * car.g))) * car.m
        # What is left out is a product of p⁗ with p̈/g.
        left_out = snap.norm() * car.m_q * car.length / car.g * (size / (car.g - size) + lean)
        assert (exact - linear).norm() <= left_out, "(13.5)"
        angle = RANDOM.uniform(0.05, 1.0)
        most = car.g * math.tan(angle) / (1 + math.tan(angle))
        close(most / (car.g - most), math.tan(angle), 1e-12, "γ of (13.6)")
    # (13.7): with the least duration allowed, the profile's peaks are at the limits.
    p1, p2, p4 = 2.9326, 13.177, 1341.1
    distance, speed, accel, snap = 12.0, 1.5, 0.8, 0.3
    t = max(p1 * distance / speed, math.sqrt(p2 * distance / accel), (p4 * distance / snap) ** 0.25)
    within = (p1 * distance / t / speed, p2 * distance / t**2 / accel, p4 * distance / t**4 / snap)
    close(max(within), 1.0, 1e-12, "one limit is met, none exceeded")


@covers("14.1", "14.2", "14.3", "14.4", "14.5", "14.8", "14.9")
def hold():
    car = TABLE_I
    for _ in range(20):
        x = State.of(random_x())
        first, pushed, second = (Vec(*numbers(3, 1.0)) for _ in range(3))
        thrust = 20.0 + 5.0 * pushed[0]
        dist = Disturbance(NOTHING, NOTHING, NOTHING)
        v_dot, w_dot, _, _ = model(car, x, thrust, NOTHING, dist)
        b3 = x.b[2]
        pull = v_dot - w_dot * car.length - E3 * car.g + b3 * (thrust / car.m_q)
        lam = x.q.dot(v_dot - E3 * car.g)
        close(pull, x.q * (-car.m_l / car.m_q * lam), 1e-12, "(14.1)")
        # (14.3): with this force, what it was solved for.
        for a in (first, second):
            force = (E3 * car.g + pull - a) * car.m_q
            close(E3 * car.g + pull - force / car.m_q, a, 1e-12, "(14.3)")
    # (14.2): with e = v - v^ and a steady pull, e' = -2 o e - (f - f*), f' = o^2 e: both poles at -o.
    o = 10.0
    for root in roots([o * o, 2 * o]):
        close(root, -o, 1e-6, "(14.2)")
    # (14.4) and (14.5) are laws, not identities: their loops are stable without swing and with one-sided limits off.
    for coefficients in ([0.3, 1.0, 2.0], [64.0, 16.0]):
        assert all(root.real < 0 for root in roots(coefficients))
    # (14.8): the determinant of x and s, against the polynomial that is wanted.
    for omega, p, d in ((0.8, 0.8, 0.24), (2.2, 1.0, 0.3), (4.4, 0.7, 0.5)):
        k_p, k_d = p * p, 2 * p + 2 * d * p * p / omega**2
        k_s, k_q = 2 * d * (1 - p * p / omega**2), 4 * d * p
        for sigma in (0.3, -1.1, 2.0, 0.7j, 1.0 - 0.4j):
            given = (sigma**2 + k_d * sigma + k_p) * (sigma**2 + omega**2) + sigma**2 * (k_s * sigma + k_q)
            wanted = (sigma**2 + 2 * d * sigma + omega**2) * (sigma + p) ** 2
            assert abs(given - wanted) < 1e-12 * abs(wanted), "(14.8)"
    # (14.9): of a load at rest under g e3 + d with any error along the rod, its lean to the second order.
    for lean in (0.01, 0.1, 0.3):
        turn, along = RANDOM.uniform(0.0, 6.3), RANDOM.uniform(-5.0, 5.0)
        level = Vec(math.cos(turn), math.sin(turn), 0.0)
        wind = level * (car.g * math.tan(lean))
        q = level * math.sin(lean) + E3 * math.cos(lean)
        d = wind + q * along
        found = (d - q * d.dot(q)) * (car.length / car.g)
        found = found - E3 * found.dot(E3)
        assert (found - level * (car.length * math.sin(lean))).norm() < car.length * lean**3, "(14.9)"


@covers("14.6", "14.7")
def landing_by_the_rod():
    car = TABLE_I
    for _ in range(20):
        payload, (turn, phi, speed, share) = Vec(*numbers(3, 3.0)), (abs(x) for x in numbers(4, 0.6))
        level = Vec(math.cos(turn), math.sin(turn), 0.0)

        def target(t):
            angle = phi + speed / car.length * t
            return payload + (level * math.sin(angle) - E3 * math.cos(angle)) * car.length

        close((target(0.0) - payload).norm(), car.length, 1e-12, "(14.6): the cable is taut")
        moving = (level * math.cos(phi) + E3 * math.sin(phi)) * speed
        close(derivative(lambda t: list(target(t))), moving, 1e-8, "(14.6)")
        # (14.7): rotors that give 1/s of what they are told leave the tension that was meant.
        q = (payload - target(0.0)) / car.length
        s = 1.0 / RANDOM.uniform(0.8, 1.2)
        f = E3 * ((s - 1) * car.g) + q * (s * share * car.m_l / car.m_q * car.g)
        given = (E3 * car.g + f) * (car.m_q / s)
        close(E3 * (car.m_q * car.g) - given, q * (-share * car.m_l * car.g), 1e-12, "(14.7)")


@covers("14.10")
def turning():
    # A body that turns about a fixed axis: its rate is found from the attitude as by a filter of 20/s, and
    # the attitude from its rate.
    h, axis, rate = 0.001, Vec(1.0, 2.0, -2.0) / 3.0, 1.3

    def turned(b, angle):
        """R Exp(axis angle), by columns."""
        k, sin, cos = list(axis), math.sin(angle), math.cos(angle)
        cross = [[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]]
        m = [[(i == j) * cos + sin * cross[i][j] + (1 - cos) * k[i] * k[j] for j in range(3)] for i in range(3)]
        return [b[0] * m[0][j] + b[1] * m[1][j] + b[2] * m[2][j] for j in range(3)]

    truth, found = [E1, E2, E3], Vec(0.0, 0.0, 0.0)
    for _ in range(100):
        angle = found.dot(axis) * h
        before, truth = turned(truth, angle), turned(truth, rate * h)
        m = [[before[i].dot(truth[j]) for j in range(3)] for i in range(3)]
        off = Vec(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]) / 2.0
        found = found + off * 20.0
    close(found, axis * (rate * (1 - (1 - 20 * h) ** 100)), 1e-6, "(14.10), the rate")
    led = [E1, E2, E3]
    for _ in range(100):
        led = turned(led, rate * h)
    for column, wanted in zip(led, truth):
        close(column, wanted, 1e-12, "(14.10), the attitude")


@covers("15.2", "15.3", "15.4", "15.5", "15.6")
def curves():
    # (15.2) by differences.
    n, u1 = Vec(1.0, 2.0, 2.0) / 3.0, Vec(2.0, 1.0, -2.0) / 3.0
    u2, center, a, b = n.cross(u1), Vec(0.3, -0.2, 1.0), 2.0, 1.5

    def functions(p):
        x, y = u1.dot(p - center), u2.dot(p - center)
        return [(x / a) ** 2 + (y / b) ** 2 - 1, -n.dot(p - center)]

    p = Vec(1.2, 0.7, 0.1)
    partials = [derivative(lambda t, e=e: functions(p + e * t)) for e in (E1, E2, E3)]
    g1, g2 = (Vec(*(row[i] for row in partials)) for i in range(2))
    x, y = u1.dot(p - center), u2.dot(p - center)
    close(g1.cross(g2), (u2 * (x / a**2) - u1 * (y / b**2)) * 2.0, 1e-9, "(15.2)")

    # (15.3) to (15.5): a knot's nearest point by brute force, and gradients by differences.
    def c(s):
        return Vec(3 * math.cos(s), 2 * math.sin(s), 0.6 * math.sin(2 * s))

    def c1(s):
        return Vec(-3 * math.sin(s), 2 * math.cos(s), 1.2 * math.cos(2 * s))

    def c2(s):
        return Vec(-3 * math.cos(s), -2 * math.sin(s), -2.4 * math.sin(2 * s))

    def nearest(p, s):
        for _ in range(50):
            r = p - c(s)
            s += r.dot(c1(s)) / (c1(s).dot(c1(s)) - r.dot(c2(s)))
        return s

    e = E3

    def located(p, s):
        s = nearest(p, s)
        r, t = p - c(s), c1(s)
        w = t.cross(e)
        return [r.dot(e) * t.norm() / w.norm(), r.dot(w) / w.norm(), s]

    for start in (0.3, 1.9, 4.0):
        p = c(start) + Vec(*numbers(3, 0.2))
        s = nearest(p, start)
        grid = min(((p - c(start + d / 1e4)).norm(), d) for d in range(-5000, 5000))
        close((p - c(s)).norm(), grid[0], 1e-7, "nearest")
        h1, h2, _ = located(p, s)
        close(math.hypot(h1, h2), (p - c(s)).norm(), 1e-12, "|(h1, h2)| is the distance")
        t = c1(s) / c1(s).norm()
        n1 = e - t * e.dot(t)
        n1 = n1 / n1.norm()
        r = p - c(s)
        close((h1, h2), (r.dot(n1), r.dot(t.cross(n1))), 1e-12, "(15.4)")
        gradient = [derivative(lambda d, u=u: located(p + u * d, s)[2], 1e-4) for u in (E1, E2, E3)]
        divisor = c1(s).dot(c1(s)) - r.dot(c2(s))
        close(gradient, c1(s) / divisor, 1e-7, "∇σ")
        across = c1(s).cross(c2(s))
        curvature = across.norm() / c1(s).norm() ** 3
        inward = across.cross(c1(s))
        d = r.dot(inward) / inward.norm()
        close(divisor / c1(s).dot(c1(s)), 1 - curvature * d, 1e-10, "(15.5)")

    # (15.6): the circle's curvature from u = ∇h1 × ∇h2, and the limit that the speed obeys.
    p = Vec(3.0, 4.0, 0.0)
    u = Vec(2 * p[1], -2 * p[0], 0.0)
    du_u = Vec(2 * u[1], -2 * u[0], 0.0)
    square = u.cross(du_u).dot(u.cross(du_u)) / u.dot(u) ** 3
    close(square, 1 / 25, 1e-14, "κ_C²")
    for v0 in (0.5, 3.0, 30.0):
        v = v0 * (1 + square * (v0 * v0 / 1.2) ** 2) ** -0.25
        assert v <= v0 and v * v * math.sqrt(square) <= 1.2


@covers("15.8", "15.9", "15.10")
def splines():
    """A span against de Boor's recursion over its knots, and its derivatives by differences."""

    def bases(degree, u):
        row = [1.0] + [0.0] * degree
        for d in range(1, degree + 1):
            last = lambda i: row[i] if 0 <= i < d else 0.0  # noqa: E731
            row = [((u + d - i) * last(i - 1) + (1 - u + i) * last(i)) / d for i in range(d + 1)]
        return row

    def de_boor(points, u):
        # The span [7, 8] of knots 0 … 15.
        t, column = 7 + u, list(points)
        for r in range(1, 8):
            for j in range(7, r - 1, -1):
                share = (t - j) / (8 - r)
                column[j] = column[j - 1] * (1 - share) + column[j] * share
        return column[7]

    points = [Vec(*numbers(3, 3.0)) for _ in range(8)]
    for u in (0.0, 0.2, 0.7, 1.0):
        differences = list(points)
        for k in range(4):
            coefficient = NOTHING
            for weight, d in zip(bases(7 - k, u), differences):
                coefficient = coefficient + d * (weight / math.factorial(k))
            if k == 0:
                close(coefficient, de_boor(points, u), 1e-13, "(15.8), the curve")
            elif k == 1:
                close(coefficient, derivative(lambda h: de_boor(points, u + h), 1e-3), 1e-9, "(15.8), its derivative")
            differences = [b - a for a, b in zip(differences, differences[1:])]
        close(sum(bases(7, u)), 1.0, 1e-14, "the weights")


@covers("15.11")
def stops():
    target, most, rate, s, h = 20.0, 2.0, 0.5, 0.0, 0.001
    places = []
    for i in range(40000):
        middle = s + h / 2 * most * math.tanh(rate * (target - s) / most)
        s += h * most * math.tanh(rate * (target - middle) / most)
        if i in (20000, 21000):
            places.append(target - s)
    close(places[1] / places[0], math.exp(-rate), 1e-3, "the rate of the approach")
    close(s, target, 1e-5, "the stop")


@covers("16.1")
def rotors():
    """Force and torque of one rotor by the cross product."""
    for _ in range(10):
        x, y, f = RANDOM.uniform(-1, 1), RANDOM.uniform(-1, 1), RANDOM.uniform(0, 9)
        torque = Vec(x, y, 0.0).cross(Vec(0.0, 0.0, -f))
        close((torque[0], torque[1], torque[2]), (-y * f, x * f, 0.0), 1e-15, "(16.1)")
