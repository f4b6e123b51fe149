"""Descriptions, drawings and units of the card of a verdict."""

import re
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest

from comprope.rope.effects import INSTRUMENT, REGISTRY
from comprope_system.identification.prediction.plant_parameters import PLANT_PARAMETERS
from comprope_system.identification_results.reporting.texts.detection_limits import detection_sentence
from comprope_system.identification_results.reporting.texts.effect_descriptions import MEANINGS, drawing, meaning
from comprope_system.identification_results.reporting.texts.formatting import in_handy_unit, listed_words, number
from comprope_system.identification_results.reporting.texts.sentences import verdict_sentences
from comprope_system.report.card import Card
from comprope_system.report.page import Section, save_page

COLOURS = ("ink", "soft", "pale", "measured", "good")
KNOWN = [name for name, one in REGISTRY.items() if one.hypothesis and not one.source]
EFFECTS = [*KNOWN, *INSTRUMENT, "adequate", "unknown"]


@pytest.mark.parametrize("effect", EFFECTS)
def test_every_effect_of_the_project_has_two_sentences_and_a_drawing_of_its_own(effect):
    assert len(re.findall(r"\.(?: |$)", MEANINGS[effect])) == 2
    assert drawing(effect).replace(effect.replace("_", " "), "") != drawing("of_the_user").replace("of the user", "")
    ElementTree.fromstring(drawing(effect))
    assert set(re.findall(r'(?:fill|stroke)="([^"]+)"', drawing(effect))) <= {"none", *(f"var(--{name})" for name in COLOURS)}


def test_an_effect_of_the_user_is_described_by_its_own_file():
    class Own:
        """Rails push the rope
        at their joints.

        More is said here.
        """

    REGISTRY["own_joints"] = Own
    try:
        assert meaning("own_joints") == "Rails push the rope at their joints."
    finally:
        del REGISTRY["own_joints"]


@pytest.mark.parametrize(
    ("unit", "values", "wanted"),
    [
        ("m", (0.0045678, 0.0045), ("4.57 mm", "4.5 mm")),
        ("m", (1.5, 0.01), ("1.5 m", "0.01 m")),
        ("N.m", (22.04,), ("22 N·m",)),
        ("N.s/m", (165432.0,), ("165 kN·s/m",)),
        ("s", (-0.352,), ("-352 ms",)),
        ("1", (0.965,), ("0.965",)),
    ],
)
def test_values_are_told_in_one_handy_unit_with_three_digits(unit, values, wanted):
    assert in_handy_unit(unit, *values) == wanted


def test_numbers_have_three_digits_and_no_exponent_where_it_is_not_needed():
    assert [number(one) for one in (2519.3, 35_612.0, 0.012345, 7.0, 1.5e9, float("nan"))] == [
        "2520",
        "35600",
        "0.0123",
        "7",
        "1.5e+09",
        "–",
    ]
    assert [listed_words(one) for one in ([], ["a"], ["a", "b"], ["a", "b", "c"])] == ["", "a", "a and b", "a, b and c"]


def test_an_effect_could_not_be_seen_if_no_parameter_of_typical_size_would_be():
    key = "effects.bearing_friction"
    limits = [{f"{key}.coulomb_torque": torque, f"{key}.viscous": 0.25} for torque in (0.5, 7.0)]
    hypothesis = SimpleNamespace(effect="bearing_friction", parts=())
    found = [
        detection_sentence(SimpleNamespace(verdict=None, ranking=[SimpleNamespace(hypothesis=hypothesis, detection_limits=one)]))
        for one in limits
    ]
    assert found == [
        "Each known effect would have been seen at its typical size.",
        "These data would not have shown bearing friction below Coulomb torque 7 N·m.",
    ]


@pytest.mark.parametrize(("left", "told"), [(0.25, "less than the noise by a factor of 2: it is overestimated"), (0.41, "")])
def test_noise_that_is_far_larger_than_what_is_left_is_reported(left, told):
    found = SimpleNamespace(
        verdict=None, kind="adequate", ranking=[], probabilities={"adequate": 0.9}, campaign=None, indistinguishable=(),
        baseline=SimpleNamespace(chi_square=1000.0 * left, coefficients=np.zeros(len(PLANT_PARAMETERS))),
        problem=SimpleNamespace(ruled_out=(), data=np.zeros(1000), plant=PLANT_PARAMETERS),
    )  # fmt: skip
    text = " ".join(verdict_sentences(SimpleNamespace(diagnosis=found)))
    assert (told in text) if told else ("overestimated" not in text)


def test_texts_of_a_card_are_escaped(tmp_path):
    odd = '<b>& "</b>'
    card = Card(odd, odd, [odd], [drawing("air_drag")], [(odd, odd, odd)], [(odd, odd)], odd)
    save_page(tmp_path / "page.html", "", "", [Section("a", "A", [card])])
    text = (tmp_path / "page.html").read_text("utf-8")
    assert "<b>" not in text and text.count("&lt;b&gt;") == 9 and "<svg" in text
