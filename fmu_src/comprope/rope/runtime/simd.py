"""A number for each of LANES directions as one value of the compiled kernels: loaded, added, multiplied, stored.

Kernels that treat several directions alike write their formulas once; the processor's vector units do
all lanes together. A product and a sum may be rounded as one, so the last bits depend on the processor: this is
not for the rope's own motion. Without a compiler a lane is a small numpy array, and the same formulas hold.
"""

import operator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.typing import signature
from numba.core.typing.templates import ConcreteTemplate, infer_global
from numba.extending import intrinsic, lower_builtin, models, register_model

from ...kernels.jit import PURE

LANES = 4
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_JOINED = ("contract",)


class Lanes(types.Type):
    """The type of a number for each direction."""

    def __init__(self) -> None:
        super().__init__(name=f"Lanes({LANES})")


lanes = Lanes()


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)


@infer_global(operator.add)
@infer_global(operator.sub)
class _Sum(ConcreteTemplate):
    cases = (signature(lanes, lanes, lanes),)


@infer_global(operator.mul)
class _Product(ConcreteTemplate):
    cases = (signature(lanes, types.float64, lanes),)


@lower_builtin(operator.add, lanes, lanes)
def _add(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    return builder.fadd(*arguments, flags=_JOINED)


@lower_builtin(operator.sub, lanes, lanes)
def _subtract(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    return builder.fsub(*arguments, flags=_JOINED)


@lower_builtin(operator.mul, types.float64, lanes)
def _multiply(_context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
    number, vector = arguments
    return builder.fmul(_spread(builder, number), vector, flags=_JOINED)


def _spread(builder: Any, number: Any) -> Any:
    """A vector of equal numbers."""
    one = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
    every = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
    return builder.shuffle_vector(one, ir.Constant(_VECTOR, ir.Undefined), every)


def _place(context: Any, builder: Any, kind: Any, array: Any, index: Any) -> Any:
    """Address of the vector that begins at an index of an array."""
    data = array if isinstance(kind, types.CPointer) else context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), _VECTOR.as_pointer())


@intrinsic
def _load(_typing, R, i):
    def write(context, builder, kinds, arguments):
        return builder.load(_place(context, builder, kinds.args[0], *arguments), align=8)

    return lanes(R, types.int64), write


@intrinsic
def _store(_typing, R, i, x):
    def write(context, builder, kinds, arguments):
        builder.store(arguments[2], _place(context, builder, kinds.args[0], *arguments[:2]), align=8)
        return context.get_dummy_value()

    return types.void(R, types.int64, lanes), write


def _load_in_python(R, i):
    return np.array(R[i : i + LANES])


def _store_in_python(R, i, x):
    R[i : i + LANES] = x


load: Any = _load_in_python if PURE else _load
store: Any = _store_in_python if PURE else _store
