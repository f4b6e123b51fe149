"""The page inside an FMU: its pictures speak of the variables by their names."""

import io
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator

import numpy as np
import pytest
from PIL import Image

from comprope.drive.cosimulation import interface as drive_interface
from comprope.fmi.arrays import groups_of
from comprope.fmi.documentation import documentation_page
from comprope.fmi.icon import SIZE, icon
from comprope.fmi.model_interface import ModelInterface
from comprope.rope.model_file import load
from comprope.rope.simulator.cosimulation import interface as rope_interface
from comprope_system import presets

ROPE, DRIVE = rope_interface(load(presets.model_path("tower50"))), drive_interface()
SVG = "{http://www.w3.org/2000/svg}"
# Numbers without a place in the elevator, or that their line of help tells better than a picture.
UNSEEN = {
    "shaft.gravity", "rope.count", "solver.step", "solver.numerical_damping", "derivative_inputs", "inputs_at_end",
    "profile.smoothing", "trip.start_position", "trip.destination", "servo.torque_limit", "servo.sample_period",
    "servo.velocity_feedforward", "servo.acceleration_feedforward", "rope.compression_ratio", "sheave.limit_switch",
    "shaft.walls_follow", "trip.overrun",
}  # fmt: skip


def labels(model: ModelInterface) -> Iterator[str]:
    """Names of variables in the pictures: what stands in typewriter letters, with k for any number."""
    for path in model.pictures:
        for group in ET.parse(path).iter(f"{SVG}g"):
            if group.get("font-family") == "monospace":
                texts = (one.text or "" for one in group.iter(f"{SVG}text") if not one.get("font-family"))
                yield from (name.replace("[k]", "[1]") for text in texts for name in re.split(r",\s*", text) if name)


def test_rope_and_drive_have_icons_of_their_own():
    pictures = {}
    for name in ("sheave", "machine"):
        with Image.open(io.BytesIO(icon(name))) as image:
            pictures[name] = np.asarray(image.convert("RGBA"))
    assert pictures["sheave"].shape == pictures["machine"].shape == (SIZE, SIZE, 4)
    seen = {name: one[..., 3] > 128 for name, one in pictures.items()}
    assert np.mean(seen["sheave"] != seen["machine"]) > 0.1
    assert [ROPE.icon, DRIVE.icon] == ["sheave", "machine"]


@pytest.mark.parametrize("model", [ROPE, DRIVE], ids=lambda model: model.name)
def test_pictures_show_what_is_declared(model: ModelInterface) -> None:
    assert set(labels(model)) <= {one.name for one in model.variables}


@pytest.mark.parametrize("model", [ROPE, DRIVE], ids=lambda model: model.name)
def test_every_parameter_is_in_a_picture_or_known_to_be_in_none(model: ModelInterface) -> None:
    series = re.compile(r"curve\.|shaper\.|brake\.|safety_gear\.|buffer\.|traction\.|sensors\[[2-9]|.*\.on_counterweight_side")
    names = {one.name for one in model.of_role("parameter") if not series.match(one.name)}
    assert names - set(labels(model)) <= UNSEEN


def test_the_page_holds_every_picture_and_variable() -> None:
    text, scalars = (documentation_page(ROPE, "1.2.3", systems="Linux", fmi=version) for version in ("3.0", "2.0"))
    assert text.count("<svg ") == len(ROPE.pictures) == 5
    assert all(f"<code>{one.name}</code>" in scalars for one in ROPE.variables)
    assert all(f"<code>{group.variable.name}</code>" in text for group in groups_of(ROPE)) and "[1]" not in text
    assert "<td>real, 4 values</td>" in text and "<td>real, tunable</td>" in scalars
    assert "FMI 3.0 co-simulation" in text and "fmi3Error" in text
