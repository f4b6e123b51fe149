"""The files of a campaign."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .sites import Channel, Site
from .tower import Floats

MODEL = """\
# The {title} as its designers describe it; the plant differs a little.
[shaft]
height = {p.height}
pit = {p.pit}

[rope]
mass_per_length = {p.mass_per_length}
diameter = {p.diameter}
axial_stiffness = {p.EA}
bending_stiffness = {p.EI}
axial_damping = {p.axial_damping}
bending_damping = {p.bending_damping}
element_length = 0.05

[sheave]
mass = {p.sheave_mass}
radius = {p.radius}
inertia = {p.inertia}

[contact]
stiffness = {p.contact_stiffness}
damping = {p.contact_damping}
friction_coefficient = {p.friction}
slip_velocity = {p.slip_velocity}
"""
SENSOR = '\n[[sensors]]\nname = "{name}"\nside = "{side}"\nheight = {height}\n'
SIDES = {-1.0: "car", 1.0: "counterweight"}
CHANNEL = (
    '\n[[channels]]\ncolumn = "{column}"\nquantity = "{c.quantity}"\n{sensor}unit = "{c.unit}"\nreference = "{c.reference}"\n'
)
RUN = '\n[[runs]]\nfile = "{name}.csv"\nrole = "{role}"\nset = {{ "sheave.mass" = {mass}, "sheave.inertia" = {inertia:.3f} }}\n'


def describe(folder: Path, site: Site, seed: int, stated: float | None) -> None:
    """Write campaign.toml and the model under test; `stated` is the noise stated over the true one, None for none stated."""
    text = f'name = "{site.title}, {seed}"\nmodel = "{site.name}.toml"\n'
    for column, channel in site.channels.items():
        text += described(site, column, channel) + ("" if stated is None else f"noise = {channel.noise * stated:.4g}\n")
    for name, run in site.runs.items():
        mass, inertia = site.tower.sheave_mass * run.share, site.tower.inertia * run.share
        text += RUN.format(name=name, role=run.role, mass=mass, inertia=inertia)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    model = MODEL.format(title=site.title, p=site.tower)
    sensors = (SENSOR.format(name=name, side=SIDES[side], height=height) for name, (side, height) in site.sensors.items())
    (folder / f"{site.name}.toml").write_text(model + "".join(sensors), encoding="utf-8")


def described(site: Site, column: str, channel: Channel) -> str:
    """A channel's part of campaign.toml, without its noise."""
    sensor = f'sensor = "{channel.source}"\n' if channel.source in site.sensors else ""
    return CHANNEL.format(column=column, c=channel, sensor=sensor)


def table(path: Path, rows: Mapping[str, Floats]) -> None:
    """Write columns as CSV; what is not there stays empty."""
    lines = [",".join(rows)]
    for values in np.column_stack(list(rows.values())):
        cells = (f"{value:.{3 if k == 0 else 4}f}" for k, value in enumerate(values))
        lines.append(",".join("" if cell == "nan" else cell for cell in cells))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
