"""Vectors, power series in time, polynomials, and how near two numbers have to be."""

import cmath
import math


def close(found, expected, tolerance, what):
    """|found − expected| ≤ tolerance · (1 + |expected|), number by number."""
    if hasattr(found, "__iter__"):
        found, expected = list(found), list(expected)
        assert len(found) == len(expected), f"{what}: {len(found)} numbers for {len(expected)}"
        for f, e in zip(found, expected):
            close(f, e, tolerance, what)
    else:
        error = abs(found - expected) / (1 + abs(expected))
        assert error <= tolerance, f"{what}: {found} for {expected}, off by {error:.1e}"


class Vec(tuple):
    """A vector of three numbers, or of three series."""

    def __new__(cls, *components):
        return super().__new__(cls, components)

    def __add__(self, other):
        return Vec(*(a + b for a, b in zip(self, other)))

    def __sub__(self, other):
        return Vec(*(a - b for a, b in zip(self, other)))

    def __mul__(self, scalar):
        return Vec(*(a * scalar for a in self))

    __rmul__ = __mul__

    def __neg__(self):
        return self * -1.0

    def __truediv__(self, scalar):
        return Vec(*(a / scalar for a in self))

    def dot(self, other):
        a, b, c = (x * y for x, y in zip(self, other))
        return a + b + c

    def cross(self, other):
        (a, b, c), (x, y, z) = self, other
        return Vec(b * z - c * y, c * x - a * z, a * y - b * x)

    def norm(self):
        return math.sqrt(self.dot(self))


E1, E2, E3 = Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0)
NOTHING = Vec(0.0, 0.0, 0.0)


class Series:
    """A truncated power series in time; `c[k]` is the k-th derivative over k!."""

    def __init__(self, c):
        self.c = list(c)

    @classmethod
    def of(cls, derivatives):
        return cls(d / math.factorial(k) for k, d in enumerate(derivatives))

    def lift(self, other):
        return other if isinstance(other, Series) else Series([other] + [0.0] * (len(self.c) - 1))

    def __add__(self, other):
        return Series(a + b for a, b in zip(self.c, self.lift(other).c))

    __radd__ = __add__

    def __neg__(self):
        return Series(-a for a in self.c)

    def __sub__(self, other):
        return self + -self.lift(other)

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        if not isinstance(other, Series):
            return Series(a * other for a in self.c)
        n = min(len(self.c), len(other.c))
        return Series(sum(self.c[j] * other.c[k - j] for j in range(k + 1)) for k in range(n))

    __rmul__ = __mul__

    def __truediv__(self, other):
        other = self.lift(other)
        quotient = []
        for k in range(min(len(self.c), len(other.c))):
            rest = self.c[k] - sum(quotient[j] * other.c[k - j] for j in range(k))
            quotient.append(rest / other.c[0])
        return Series(quotient)

    def __pow__(self, n):
        return self if n == 1 else self * self ** (n - 1)

    def sqrt(self):
        root = [math.sqrt(self.c[0])]
        for k in range(1, len(self.c)):
            root.append((self.c[k] - sum(root[j] * root[k - j] for j in range(1, k))) / (2 * root[0]))
        return Series(root)

    def sin(self):
        s, c = [math.sin(self.c[0])], [math.cos(self.c[0])]
        for k in range(1, len(self.c)):
            s.append(sum(j * self.c[j] * c[k - j] for j in range(1, k + 1)) / k)
            c.append(-sum(j * self.c[j] * s[k - j] for j in range(1, k + 1)) / k)
        return Series(s), Series(c)

    def atan2(self, x):
        """The angle whose tangent is self/x."""
        square = x * x + self * self
        slope = (self.diff() * x - x.diff() * self) / square
        return Series([math.atan2(self.c[0], x.c[0])] + [a / (k + 1) for k, a in enumerate(slope.c)])

    def diff(self):
        return Series((k + 1) * a for k, a in enumerate(self.c[1:]))

    def at(self, k):
        """The k-th derivative."""
        return self.c[k] * math.factorial(k)


def derivative(f, h=1e-5):
    """df/dt at 0 by central differences of fourth order."""
    a, b, c, d = f(-2 * h), f(-h), f(h), f(2 * h)
    if isinstance(a, (tuple, list)):
        return [(8 * (z - y) - (w - x)) / (12 * h) for x, y, z, w in zip(a, b, c, d)]
    return (8 * (c - b) - (d - a)) / (12 * h)


def place(poles):
    """Coefficients below the leading one, low order first."""
    k = [1.0]
    for pole in poles:
        k = [(k[i - 1] if i else 0.0) - pole * (k[i] if i < len(k) else 0.0) for i in range(len(k) + 1)]
    return k[:-1]


def roots(coefficients):
    """Of the monic polynomial with these, low order first (Durand and Kerner)."""
    n = len(coefficients)
    scale = 1 + max(abs(c) ** (1 / (n - i)) for i, c in enumerate(coefficients))
    z = [scale * cmath.exp(2j * math.pi * (k + 0.3) / n) for k in range(n)]
    for _ in range(2000):
        for i in range(n):
            value = 1.0 + 0j
            for c in reversed(coefficients):
                value = value * z[i] + c
            others = 1.0 + 0j
            for j in range(n):
                if j != i:
                    others *= z[i] - z[j]
            z[i] -= value / others
    return z
