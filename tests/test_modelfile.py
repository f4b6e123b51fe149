"""Model files: every problem is named at once; what is written is read back equal."""

import os
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from comprope.errors import InputError
from comprope.quantities import quantities
from comprope.rope.effects import REGISTRY
from comprope.rope.model_file import dump, load, with_changes
from comprope.rope.parameters import Base, Contact, Rope, Shaft, Sheave
from comprope_system import presets

TOWER = presets.model_path("tower50").read_text()


def refusal(tmp_path: Path, text: str | bytes) -> list[str]:
    """The lines, without the file's name, with which a model file is refused."""
    file = tmp_path / "model.toml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(InputError) as caught:
        load(file)
    lines = str(caught.value).splitlines()
    assert all(line.startswith(f"{file}: ") for line in lines)
    return [line.removeprefix(f"{file}: ") for line in lines]


def test_every_preset_loads_and_has_four_sensors():
    assert presets.names() == ["building200", "tower50", "tower50_light"]
    for name in presets.names():
        assert len(load(presets.model_path(name)).sensors) == 4


def test_light_preset_is_too_light_to_wrap_the_sheave():
    """Paper: below EI/(2 r^2) per side the rope hangs as a free loop."""
    model = load(presets.model_path("tower50_light"))
    per_side = 0.5 * model.sheave.mass * model.shaft.gravity
    assert per_side < model.rope.bending_stiffness / (2.0 * model.sheave.radius**2)


def test_all_problems_are_named_at_once(tmp_path):
    text = TOWER.replace("diameter = 0.018", "diametr = 0.018").replace("mass = 120.0", "mass = -3.0").replace('"car"', '"left"')
    lines = refusal(tmp_path, text)
    keys = ["rope.diameter", "rope.diametr = 0.018", "sheave.mass = -3.0", 'sensors[4].side = "left"']
    assert [line.split(":")[0] for line in lines] == keys
    assert 'did you mean "diameter"?' in lines[1]
    assert "a number from 0.1 to 20000 kg is accepted" in lines[2]
    assert '"car" or "counterweight" is accepted' in lines[3]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_pipe_or_a_device_is_no_model_file(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    for path in (tmp_path / "pipe.toml", Path("/dev/zero")):
        with pytest.raises(InputError, match="is a pipe or device; a regular file is accepted"):
            load(path)


def test_ropes_of_a_sheave_are_a_whole_number(tmp_path):
    (line,) = refusal(tmp_path, TOWER.replace("mass = 120.0", "mass = 120.0\nropes = 2.5"))
    assert line == "sheave.ropes: 2.5 ropes; a whole number is accepted"


@pytest.mark.parametrize("component", [Shaft, Rope, Sheave, Contact])
def test_every_number_is_refused_outside_its_declared_range(component):
    model = load(presets.model_path("tower50"))
    for one in quantities(component):
        key = f"{component.__name__.lower()}.{one.name}"
        with pytest.raises(InputError, match=rf"change: {key} = .*a number from {one.minimum:g} to ".replace("+", r"\+")):
            with_changes(model, {key: one.maximum * 1.01 + 1.0})


@pytest.mark.parametrize("value", ["nan", "inf", "true", '"120"', "[1.0]", "{a = 1}", "2024-01-01"])
def test_what_is_no_finite_number_is_refused(tmp_path, value):
    (line,) = refusal(tmp_path, TOWER.replace("mass = 120.0", f"mass = {value}"))
    assert line.startswith("sheave.mass") and "kg is accepted" in line


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[shaft\n", "not valid TOML: Expected ']' at the end of a table declaration (at line 1, column 7)"),
        ("a = 1\na = 2\n", "not valid TOML: Cannot overwrite a value"),
        (b"# \xff\n", "not UTF-8 text (byte 3)"),
        (b"\x00", "not valid TOML"),
        ("a = " + "[" * 5000, "not valid TOML"),
    ],
)
def test_a_broken_file_is_one_line(tmp_path, text, expected):
    (line,) = refusal(tmp_path, text)
    assert line.startswith(expected)


def test_a_missing_file_and_a_folder_are_named(tmp_path):
    for path, sentence in ((tmp_path, "is a folder"), (tmp_path / "absent.toml", "cannot be read: ")):
        with pytest.raises(InputError, match=f": {sentence}"):
            load(path)


def test_files_of_windows_editors_are_read(tmp_path):
    file = tmp_path / "model.toml"
    file.write_bytes(b"\xef\xbb\xbf" + TOWER.replace("\n", "\r\n").encode())
    assert load(file) == load(presets.model_path("tower50"))


def test_problems_across_components_are_told(tmp_path):
    (line,) = refusal(tmp_path, TOWER.replace("element_length = 0.05", "element_length = 0.3"))
    assert line.startswith("rope.element_length = 0.3 m is too coarse for the sheave")
    (line,) = refusal(tmp_path, TOWER.replace('"cw_mid"', '"cw_low"'))
    assert line.startswith("sensors: each name")


def test_an_unknown_effect_is_named_with_the_nearest(tmp_path):
    (line,) = refusal(tmp_path, TOWER + "\n[effects.airdrag]\ndrag_coefficient = 1.0\n")
    assert line == 'effects.airdrag: unknown key; did you mean "air_drag"?'


def test_changes_bring_an_effect_in_and_leave_the_rest():
    model = load(presets.model_path("tower50"))
    changed = with_changes(model, {"sheave.mass": 90, "effects.air_drag.drag_coefficient": 1.1, "sensors[2].height": 12.0})
    assert (changed.sheave.mass, changed.sensors[1].height) == (90.0, 12.0)
    assert changed.effects.air_drag.drag_coefficient == 1.1
    assert changed.rope == model.rope
    assert model.effects.air_drag is None


@pytest.mark.parametrize(
    "key",
    ["", "sheave..mass", "sensors[9].height", "sensors[0].height", "sensors[1]", "sheave.mass.x", "mass", "shaft[1].height"],
)
def test_changes_of_what_is_no_value_are_refused(key):
    with pytest.raises(InputError, match=r"^--set: "):
        with_changes(load(presets.model_path("tower50")), {key: 1.0}, "--set")


@settings(max_examples=30, deadline=None)
@given(mass=st.floats(0.1, 20000.0), stiffness=st.floats(0.0, 2000.0), drag=st.floats(0.0, 10.0), heading=st.text(max_size=20))
def test_what_is_written_is_read_back_equal(tmp_path_factory, mass, stiffness, drag, heading):
    file = tmp_path_factory.mktemp("models") / "sub" / "model.toml"
    changes = {"sheave.mass": mass, "rope.bending_stiffness": stiffness, "effects.air_drag.drag_coefficient": drag}
    model = with_changes(load(presets.model_path("tower50")), changes)
    dump(model, file, comment=heading)
    assert load(file) == model
    assert [path.name for path in file.parent.iterdir()] == ["model.toml"]


def test_a_file_that_cannot_be_written_is_told(tmp_path):
    with pytest.raises(InputError, match="is a folder; give the name of a file"):
        dump(load(presets.model_path("tower50")), tmp_path)


def test_the_model_is_frozen():
    model = load(presets.model_path("tower50"))
    assert isinstance(model, Base)
    with pytest.raises(ValueError, match="frozen"):
        model.sheave.mass = 1.0


def test_the_order_of_effects_stays() -> None:
    """It is that of the FMU's variables, whose value references hosts keep: a new effect comes last."""
    built_in = [name for name, effect in REGISTRY.items() if not effect.source]
    assert built_in == [
        "air_drag", "shaft_airflow", "bending_hysteresis", "intrinsic_curvature", "building_sway", "attachment_offset",
        "sheave_eccentricity", "bearing_friction", "guide_friction", "sheave_damper", "end_stops", "tie_down",
        "shaft_walls", "sheave_unbalance", "jammed_seal", "jammed_guide", "sticky_guide", "rope_brush", "rope_guide",
        "encoder_scale", "sloped_guide",
    ]  # fmt: skip
