"""Arrays of FMI 3.0, made of scalars whose names differ in an index."""

from dataclasses import replace

import pytest

from comprope.fmi.arrays import groups_of, places_of
from comprope.fmi.model_interface import ModelInterface, Variable
from comprope.fmi.validation import interface_problems

GAIN = Variable("gain", "real", "parameter", "gain", start=1.0)
PAIRS = [
    Variable(f"{name}[{k}]", kind, "output", f"{name} {k}", array=f"all {name}s")  # type: ignore[arg-type]
    for k in (1, 2, 3)
    for name, kind in (("reading", "real"), ("valid", "boolean"))
]


def model(*variables: Variable) -> ModelInterface:
    return ModelInterface("Toy", "toy", variables, lambda *_: None)  # type: ignore[arg-type, return-value]


def test_elements_that_alternate_make_two_arrays() -> None:
    gain, reading, valid = groups_of(model(GAIN, *PAIRS))
    assert (gain.is_array, gain.place, gain.variable) == (False, 0, GAIN)
    assert (reading.variable.name, reading.variable.help, reading.place, reading.stride) == ("reading", "all readings", 1, 2)
    assert (valid.variable.name, valid.place, valid.stride, len(valid.elements)) == ("valid", 2, 2, 3)
    assert places_of((gain, reading, valid))["valid[3]"] == 2


def test_one_element_is_an_array_too() -> None:
    (alone,) = groups_of(model(PAIRS[0]))
    assert alone.is_array and alone.variable.name == "reading"


@pytest.mark.parametrize(
    ("variables", "sentence"),
    [
        ((PAIRS[0], replace(PAIRS[2], unit="m")), "elements of an array are alike, at equal distances"),
        ((PAIRS[0], PAIRS[2], GAIN, PAIRS[4]), "elements of an array are alike, at equal distances"),
        ((PAIRS[2], PAIRS[4]), "the elements of an array are numbered from 1"),
        ((replace(GAIN, role="input", tunable=True),), "only a parameter is tunable"),
    ],
)
def test_what_cannot_be_declared(variables: tuple[Variable, ...], sentence: str) -> None:
    assert any(sentence in problem for problem in interface_problems(model(*variables)))
