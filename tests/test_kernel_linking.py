"""Kernels of several modules in one namespace: a name stands for one thing."""

import types
from math import sqrt

import pytest

from comprope.kernels.inlining import inlined_kernel
from comprope.kernels.jit import PURE, kernel
from comprope.kernels.kernel_linking import linked, merged


@kernel
def double(x):
    return 2.0 * x


@kernel
def hook(x):
    return 0.0


@kernel
def caller(x):
    return double(x) + hook(x)


def module(name: str, **contents: object) -> types.ModuleType:
    made = types.ModuleType(name)
    made.__dict__.update(contents)
    return made


def test_two_kernels_of_one_name_are_refused() -> None:
    @kernel
    def other(x):
        return 3.0 * x

    first, second = module("mechanics.sensors", double=double), module("sensitivity.sensors", double=other)
    with pytest.raises(ValueError, match=r"^double is defined in mechanics.sensors and otherwise in sensitivity.sensors"):
        merged([first, second], {})


def test_a_name_imported_in_several_modules_is_one() -> None:
    first, second = module("a", double=double, sqrt=sqrt, COLUMNS=20), module("b", sqrt=sqrt, double=double, COLUMNS=20)
    assert merged([first, second], {}) == {"double": double, "sqrt": sqrt, "COLUMNS": 20}


def test_a_hook_is_replaced_wherever_it_is_imported() -> None:
    names = merged([module("a", hook=hook, caller=caller, double=double), module("b", hook=hook)], {"hook": double})
    assert linked(names, "joined", compile=kernel)["caller"](1.0) == 4.0


@pytest.mark.skipif(PURE, reason="kernels are plain functions without a compiler")
def test_a_kernel_to_be_inlined_is_for_other_kernels_only() -> None:
    inner = inlined_kernel(double.py_func)
    outer = kernel(eval("lambda x: inner(x) + 1.0", {"inner": inner}))
    assert outer(2.0) == 5.0
    with pytest.raises(TypeError):
        inner(2.0)
    assert outer(2.0) == 5.0
