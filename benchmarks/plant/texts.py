"""The files of a campaign."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .ride import SENSORS
from .tower import Floats

MODEL = """\
# The 50 m test tower as its designers describe it; the plant differs a little.
[shaft]
height = 50.0
pit = 1.5

[rope]
mass_per_length = 1.2
diameter = 0.018
axial_stiffness = 8.0e6
bending_stiffness = 20.0
axial_damping = 2.0e3
bending_damping = 0.1
element_length = 0.05

[sheave]
mass = 120.0
radius = 0.4
inertia = 9.6

[contact]
stiffness = 1.2e7
damping = 8.0e3
friction_coefficient = 0.3
slip_velocity = 0.02
"""
SENSOR = '\n[[sensors]]\nname = "{name}"\nside = "{side}"\nheight = {height}\n'
LATERAL = (
    '\n[[channels]]\ncolumn = "{name}"\nquantity = "lateral_displacement"\nsensor = "{name}"\nunit = "mm"\nreference = "rest"\n'
)
AXLE = '\n[[channels]]\ncolumn = "sheave_dx"\nquantity = "sheave_displacement"\nunit = "mm"\nreference = "rest"\n'
TURNING = '\n[[channels]]\ncolumn = "sheave_w"\nquantity = "sheave_angular_velocity"\nunit = "rad/s"\nreference = "absolute"\n'
RUN = '\n[[runs]]\nfile = "{name}.csv"\nrole = "{role}"\nset = {{ "sheave.mass" = {mass}, "sheave.inertia" = {inertia:.3f} }}\n'


def describe(folder: Path, title: str, shares: Mapping[str, float], stated: float) -> None:
    """Write campaign.toml and tower50.toml; `stated` is the noise stated over the true one."""
    text = f'name = "{title}"\nmodel = "tower50.toml"\n'
    for name in SENSORS:
        text += LATERAL.format(name=name) + f"noise = {0.2 * stated:.4g}\n"
    text += AXLE + f"noise = {0.02 * stated:.4g}\n" + TURNING + f"noise = {0.01 * stated:.4g}\n"
    for name, share in shares.items():
        role = "validate" if name == "up_short" else "fit"
        text += RUN.format(name=name, role=role, mass=120.0 * share, inertia=9.6 * share)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    sides = {-1.0: "car", 1.0: "counterweight"}
    sensors = (SENSOR.format(name=name, side=sides[side], height=height) for name, (side, height) in SENSORS.items())
    (folder / "tower50.toml").write_text(MODEL + "".join(sensors), encoding="utf-8")


def table(path: Path, rows: Mapping[str, Floats]) -> None:
    """Write columns as CSV; what is not there stays empty."""
    lines = [",".join(rows)]
    for values in np.column_stack(list(rows.values())):
        cells = (f"{value:.{3 if k == 0 else 4}f}" for k, value in enumerate(values))
        lines.append(",".join("" if cell == "nan" else cell for cell in cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
