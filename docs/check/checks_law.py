"""Sections 4 to 10, and (12.1), (12.2): lift, law, yaw, lower, gains, singularities, tracking."""

import math

from arithmetic import NOTHING, Vec, close, derivative, place, roots
from coverage import covers
from equations import Answer, Lift, State, Vehicle, lower, model, yaw_of
from reference import PATHS, RANDOM, TABLE_I, each_vector, golden, move, numbers, random_disturbance, random_x


@covers("4.1", "4.2", "4.3", "4.4", "4.5", "4.6", "4.7")
def lift():
    """The tracking reference's ξ is p to p⁽⁵⁾ itself."""
    for vector in golden("track")["vectors"]:
        found = Lift(Vehicle(*vector["par"]), State.of(vector["x"]), vector["zeta"])
        close([d[i] for i in range(3) for d in found.p], vector["xi"][:18], 1e-12, "p … p⁽⁵⁾")
        close(found.thrust, vector["T"], 1e-13, "T")


@covers("3.8", "3.9", "3.10", "5.3", "5.4", "5.5", "5.6", "5.7", "5.8", "7.2", "7.4", "7.5", "6.3")
def law():
    """ν and ū against the reference, all sets of gains; and Ā ū + b̄ = ν with the reference's own Ā and b̄."""
    for name in PATHS:
        for meta, vector, car, x, path in each_vector(name):
            for gains, k_integral, key in (
                ("gains_fig3", (0.0,) * 3, "fig3"),
                ("gains_fig56", (0.0,) * 3, "fig56"),
                ("gains_fig56", meta["Ktilde"], "fig56_int"),
            ):
                answer = Answer(car, x, vector["zeta"], path, meta[gains], vector["xint"], k_integral)
                close(answer.nu, vector[f"nu_{key}"], 1e-11, f"ν of {name}, {key}")
                u = (answer.u_zeta, *answer.torque)
                norm = math.sqrt(sum(number * number for number in vector[f"ubar_{key}"]))
                error = math.dist(u, vector[f"ubar_{key}"]) / norm
                assert error < 1e-11, f"ū of {name}, {key}: {error}"
            g1, g2 = answer.outputs.gradients
            left = (g1.dot(answer.p6), g2.dot(answer.p6), answer.outputs.rho.dot(answer.p6))
            close(left, [n - b for n, b in zip(answer.nu, answer.chi)], 1e-9, "(5.5)")
            by_matrix = [sum(a * b for a, b in zip(row, u)) + b for row, b in zip(vector["A"], vector["b"])]
            close(by_matrix, answer.nu, 1e-8, "Ā ū + b̄ = ν")


@covers("6.1", "6.2")
def yaw():
    for _ in range(20):
        coordinates_ = random_x()
        x = State.of(coordinates_)
        phi, _, psi = coordinates_[5:8]
        w1, w2, w3 = x.omega
        angle, rate, row = yaw_of(x)
        expected = (math.cos(phi) * math.sin(psi), math.cos(phi) * math.cos(psi), -math.sin(phi))
        close(row, expected, 1e-14, "second row of R")
        close((angle, rate), (psi, w3 + math.tan(phi) * (math.sin(psi) * w1 + math.cos(psi) * w2)), 1e-13, "(6.1)")
        y, xx, z = row
        b1, b2, b3 = x.b
        axes = (b2 * w3 - b3 * w2, b3 * w1 - b1 * w3, b1 * w2 - b2 * w1)
        close((xx * w3 - z * w2, z * w1 - y * w3, y * w2 - xx * w1), [a[1] for a in axes], 1e-14, "(6.2)")


@covers("7.1", "7.3", "12.1", "12.2")
def flow():
    """Lift and lower against the flow they speak of, disturbances that grow included.

    Under u_ζ and τ of a commanded p⁽⁶⁾ the payload keeps to its Taylor polynomial of sixth order, to within O(t⁷): half the
    time, 1/128 of the error. The yaw's second derivative is the commanded one.
    """
    for _ in range(6):
        x, zeta, dist = State.of(random_x()), numbers(4, 2.0), random_disturbance()
        lifted = Lift(TABLE_I, x, zeta, dist)
        p6, psi_2 = Vec(*numbers(3, 50.0)), RANDOM.uniform(-1.0, 1.0)
        torque = lower(TABLE_I, x, lifted, p6, psi_2, dist)
        errors = []
        for t in (0.06, 0.03):
            moved, _ = move(TABLE_I, x, zeta, p6[2], torque, dist, t, 60)
            polynomial = NOTHING
            for k, d in enumerate(lifted.p + [p6]):
                polynomial = polynomial + d * (t**k / math.factorial(k))
            errors.append((moved.p - polynomial).norm())
        assert 90 < errors[0] / errors[1] < 180, f"position: {errors}"
        yaw_rate = lambda t: yaw_of(move(TABLE_I, x, zeta, p6[2], torque, dist, t, 4)[0])[1]  # noqa: E731
        close(derivative(yaw_rate, 1e-3), psi_2, 1e-6, "ψ̈")
        v_dot, w_dot, _, _ = model(TABLE_I, x, lifted.thrust, torque, dist)
        close(v_dot, lifted.p[2], 1e-12, "p̈")
        close(w_dot, lifted.q2, 1e-12, "q̈")


@covers("8.1", "8.2")
def gains():
    meta = golden("circle")["meta"]
    close(place([-2.0] * 6), meta["gains_fig3"][0], 1e-15, "(s + 2)⁶")
    close(place([-1.0, -2.0, -3.0, -4.0, -5.0]), meta["gains_fig56"][2], 1e-15, "poles of Figs 5 and 6")

    def stable(poles, k_integral):
        return all(root.real < 0 for root in roots([k_integral] + place(poles)))

    for poles, below, above in (([-2.0] * 6, 42.15, 42.25), ([-1.0] * 5, 0.4175, 0.4185)):
        assert stable(poles, below) and not stable(poles, above), poles
    for degree, k_integral in ((6, 120.0), (6, 100.0), (5, 40.0)):
        assert stable([-float(i) for i in range(1, degree + 1)], k_integral)


@covers("9.1")
def determinant():
    for name in PATHS:
        for _, vector, car, x, path in each_vector(name):
            answer = Answer(car, x, vector["zeta"], path, [[0.0] * 6, [0.0] * 6, [0.0] * 5, [0.0] * 2])
            q3, along, zeta1 = x.q[2], x.q.dot(x.b[2]), vector["zeta"][0]
            f11 = car.g - car.length * car.m_q / car.m * x.w.dot(x.w) * q3
            j1, j2, j3 = car.j
            over = (car.length * car.m_q) ** 2 * j1 * j2 * j3 * q3**5 * along**3
            found = car.m**2 * (zeta1 - f11) ** 2 * (zeta1 - car.g) ** 2 * answer.delta / over
            error = abs(found / vector["det_A"] - 1)
            assert error < 1e-10, f"det Ā of {name}: {error}"


@covers("10.1")
def tracking():
    data = golden("track")
    gains_ = data["meta"]["gains_track"]
    for vector in data["vectors"]:
        car, x, t = Vehicle(*vector["par"]), State.of(vector["x"]), vector["t"]
        lifted = Lift(car, x, vector["zeta"])
        waves = [math.sin(t), math.cos(t), -math.sin(t), -math.cos(t)]
        reference = [
            [5 * waves[k % 4] for k in range(7)],
            [5 * waves[(k + 1) % 4] for k in range(7)],
            [-10.0] + [0.0] * 6,
        ]
        p6 = Vec(
            *(
                reference[i][6] - sum(k * (d[i] - r) for k, d, r in zip(gains_[i], lifted.p, reference[i]))
                for i in range(3)
            )
        )
        psi, psi_1, _ = yaw_of(x)
        psi_2 = -gains_[3][0] * psi - gains_[3][1] * psi_1
        u = (p6[2], *lower(car, x, lifted, p6, psi_2))
        norm = math.sqrt(sum(number * number for number in vector["ubar"]))
        assert math.dist(u, vector["ubar"]) / norm < 1e-11, "ū of tracking"
