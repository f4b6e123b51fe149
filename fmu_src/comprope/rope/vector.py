"""Small vector operations for `lanes`: LANES neighbouring numbers of an array at once.

The compiler does not join short loops over lanes into vector instructions by itself, so these are
spelled out; without a compiler the same loops run in Python.
"""

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from .jit import PURE

LANES = 8
_JOINED = ("contract",)  # a product and a sum may be rounded as one
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)


def subtract_in_python(R, to, a, i, b, j):
    """R[to] -= a R[i] + b R[j], for every lane."""
    for s in range(LANES):
        R[to + s] = R[to + s] - a * R[i + s] - b * R[j + s]


def turn_in_python(R, i, j, xx, xy, yx, yy):
    """Replace (R[i], R[j]) by the matrix ((xx, xy), (yx, yy)) times it, for every lane."""
    for s in range(LANES):
        x, y = R[i + s], R[j + s]
        R[i + s], R[j + s] = xx * x + xy * y, yx * x + yy * y


class _Lanes:
    """Writes the instructions for vectors in the array that a kernel was given."""

    def __init__(self, context: Any, builder: Any, kind: Any, array: Any) -> None:
        self.builder = builder
        self.data = array if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, array).data

    def place(self, index: Any) -> Any:
        """Address of the vector at an index."""
        return self.builder.bitcast(self.builder.gep(self.data, [index]), _VECTOR.as_pointer())

    def load(self, index: Any) -> Any:
        """The vector at an index."""
        return self.builder.load(self.place(index), align=8)

    def store(self, index: Any, value: Any) -> None:
        """Overwrite the vector at an index."""
        self.builder.store(value, self.place(index), align=8)

    def sum(self, a: Any, x: Any, b: Any, y: Any) -> Any:
        """The vector a x + b y."""
        return self.add(self.times(a, x), self.times(b, y))

    def times(self, number: Any, x: Any) -> Any:
        """A number times a vector."""
        return self.builder.fmul(self.spread(number), x, flags=_JOINED)

    def add(self, x: Any, y: Any) -> Any:
        """The sum of two vectors."""
        return self.builder.fadd(x, y, flags=_JOINED)

    def less(self, x: Any, y: Any) -> Any:
        """The difference of two vectors."""
        return self.builder.fsub(x, y, flags=_JOINED)

    def spread(self, number: Any) -> Any:
        """A vector of equal numbers."""
        one = self.builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
        every = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        return self.builder.shuffle_vector(one, ir.Constant(_VECTOR, ir.Undefined), every)


def _signature(R: Any, indices: str) -> Any:
    kinds = {"i": types.int64, "x": types.float64}
    return types.void(R, *(kinds[one] for one in indices))


@intrinsic
def _subtract(_typing, R, to, a, i, b, j):
    """R[to] -= a R[i] + b R[j], for every lane."""

    def write(context, builder, signature, arguments):
        R, to, a, i, b, j = arguments
        lanes = _Lanes(context, builder, signature.args[0], R)
        lanes.store(to, lanes.less(lanes.less(lanes.load(to), lanes.times(a, lanes.load(i))), lanes.times(b, lanes.load(j))))
        return context.get_dummy_value()

    return _signature(R, "ixixi"), write


@intrinsic
def _turn(_typing, R, i, j, xx, xy, yx, yy):
    """Replace (R[i], R[j]) by the matrix ((xx, xy), (yx, yy)) times it, for every lane."""

    def write(context, builder, signature, arguments):
        R, i, j, xx, xy, yx, yy = arguments
        lanes = _Lanes(context, builder, signature.args[0], R)
        x, y = lanes.load(i), lanes.load(j)
        lanes.store(i, lanes.sum(xx, x, xy, y))
        lanes.store(j, lanes.sum(yx, x, yy, y))
        return context.get_dummy_value()

    return _signature(R, "iixxxx"), write


subtract: Callable[..., None] = subtract_in_python if PURE else _subtract
turn: Callable[..., None] = turn_in_python if PURE else _turn
