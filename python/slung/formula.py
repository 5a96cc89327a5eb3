"""Curves, speeds and yaws as Python functions of the position.

The law needs six derivatives of a curve along the payload's motion, which it finds by evaluating the curve on Taylor series. A
function here is called once, with coordinates that write down what is done to them; what they wrote is evaluated in flight on the
state's series, without Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ._slung import Path

_FUNCTIONS = ("sqrt", "exp", "sin", "cos", "tanh")


class Coordinate:
    """A coordinate, or what has become of it. NumPy's functions of it work too; comparisons do not, since a curve is smooth."""

    __slots__ = ("text",)
    # Before NumPy's own numbers and arrays, which would otherwise take such an operand apart.
    __array_priority__ = 1000.0

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text

    def __add__(self, other: Operand) -> Coordinate:
        return _joined(self, "+", other)

    def __radd__(self, other: Operand) -> Coordinate:
        return _joined(other, "+", self)

    def __sub__(self, other: Operand) -> Coordinate:
        return _joined(self, "-", other)

    def __rsub__(self, other: Operand) -> Coordinate:
        return _joined(other, "-", self)

    def __mul__(self, other: Operand) -> Coordinate:
        return _joined(self, "*", other)

    def __rmul__(self, other: Operand) -> Coordinate:
        return _joined(other, "*", self)

    def __truediv__(self, other: Operand) -> Coordinate:
        return _joined(self, "/", other)

    def __rtruediv__(self, other: Operand) -> Coordinate:
        return _joined(other, "/", self)

    def __pow__(self, other: Operand) -> Coordinate:
        return _joined(self, "^", other)

    def __rpow__(self, other: Operand) -> Coordinate:
        return _joined(other, "^", self)

    def __neg__(self) -> Coordinate:
        return Coordinate(f"(-{self.text})")

    def __pos__(self) -> Coordinate:
        return self

    def __bool__(self) -> bool:
        raise TypeError("a coordinate has no value: a curve's functions are smooth, and can't decide by it")

    def __float__(self) -> float:
        raise TypeError("a coordinate has no value: use numpy's functions, not math's")

    # What numpy.sin(coordinate) calls.
    def sqrt(self) -> Coordinate:
        return _called("sqrt", self)

    def exp(self) -> Coordinate:
        return _called("exp", self)

    def log(self) -> Coordinate:
        return _called("ln", self)

    def sin(self) -> Coordinate:
        return _called("sin", self)

    def cos(self) -> Coordinate:
        return _called("cos", self)

    def tanh(self) -> Coordinate:
        return _called("tanh", self)

    def arctan2(self, x: Operand) -> Coordinate:
        return Coordinate(f"atan2({self.text}, {_text(x)})")

    def __array_ufunc__(self, ufunc: Any, method: str, *operands: Any, **keywords: Any) -> Any:
        known = _OPERATIONS.get(ufunc.__name__)
        if method != "__call__" or keywords or known is None:
            raise TypeError(f"numpy.{ufunc.__name__}: no function of a coordinate")
        return known(*operands)


Operand = Coordinate | float
"""What a coordinate is joined with."""


def _text(value: Operand) -> str:
    if isinstance(value, Coordinate):
        return value.text
    number = float(value)
    return f"({number!r})" if number < 0 else repr(number)


def _joined(left: Operand, sign: str, right: Operand) -> Coordinate:
    return Coordinate(f"({_text(left)}{sign}{_text(right)})")


def _called(function: str, value: Operand) -> Coordinate:
    return Coordinate(f"{function}({_text(value)})")


_OPERATIONS: dict[str, Callable[..., Coordinate]] = {
    "add": lambda a, b: _joined(a, "+", b),
    "subtract": lambda a, b: _joined(a, "-", b),
    "multiply": lambda a, b: _joined(a, "*", b),
    "divide": lambda a, b: _joined(a, "/", b),
    "power": lambda a, b: _joined(a, "^", b),
    "square": lambda a: _joined(a, "^", 2.0),
    "negative": lambda a: -a,
    "log": lambda a: _called("ln", a),
    "arctan2": lambda y, x: Coordinate(f"atan2({_text(y)}, {_text(x)})"),
    **{name: (lambda a, name=name: _called(name, a)) for name in _FUNCTIONS},
}


def path_of(
    surfaces: Callable[[Coordinate, Coordinate, Coordinate], tuple[Operand, Operand]],
    *,
    speed: float | dict[str, float] | Callable[..., Operand],
    yaw: float | str | dict[str, float] | Callable[..., Operand] = 0.0,
) -> Path:
    """The path along the curve where both of `surfaces(x, y, z)` are zero, in N (z down).

    `speed` (m/s) and `yaw` (rad) are as in a scenario's `[path]`, or functions of x, y and z too.
    """
    position = (Coordinate("x"), Coordinate("y"), Coordinate("z"))

    def of(function: Any) -> Any:
        return _text(function(*position)) if callable(function) else function

    h1, h2 = surfaces(*position)
    return Path(kind="implicit", h1=_text(h1), h2=_text(h2), speed=of(speed), yaw=of(yaw))
