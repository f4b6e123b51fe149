"""A campaign on the plant: drawn, driven, measured and written, with the truth beside it."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from . import campaign_files, faults
from .causes import CAUSES
from .simulate import STEP, excitation_of_trip, simulate
from .sites import TOWER50, Site
from .tower import Floats
from .trip import trip

OFF = {"EI": 0.2, "bending_damping": 0.2, "mass_per_length": 0.2, "friction": 0.2}  # how far the plant may be off the model
CAR = "car_position"
AFOOT = 0.5  # s before the trip in which the mean at rest is no longer taken


@dataclass(frozen=True)
class Plan:
    """What is hidden in a campaign: causes with their quantities, the column of an instrument's fault, the plant; and where."""

    causes: Mapping[str, Mapping[str, float]]
    plant: Mapping[str, float]
    column: str | None = None
    seed: int = 0
    level: float | None = None
    before: float = 0.0  # s that all goes on before the record begins: a building sways not only from then on
    site: Site = TOWER50
    correlation: float = 0.0  # of the instruments' noise from sample to sample, first order
    stated: bool = True  # whether campaign.toml states the noise

    @property
    def kind(self) -> str:
        """known, instrument, outside, data, pair or nothing."""
        kinds = [CAUSES[name].kind for name in self.causes]
        return "pair" if len(kinds) > 1 else kinds[0]


def draw_plan(seed: int, causes: tuple[str, ...], level: float | None = None, site: Site = TOWER50) -> Plan:
    """A campaign with given causes, everything else drawn."""
    rng = np.random.default_rng(seed)
    plant = {name: float(getattr(site.tower, name) * rng.uniform(1.0 - off, 1.0 + off)) for name, off in OFF.items()}
    level = float(rng.uniform()) if level is None else level
    columns = [column for name in causes for column in site.columns(CAUSES[name].quantities)]
    column = str(rng.choice(columns)) if columns else None
    values = {name: CAUSES[name].values(rng, site.tall, level) for name in causes}
    return Plan(values, plant, column, seed, level, site=site)


KINDS = {"known": 0.45, "pair": 0.12, "instrument": 0.08, "outside": 0.15, "nothing": 0.12, "data": 0.08}


def random_plan(seed: int, site: Site = TOWER50) -> Plan:
    """A campaign with drawn causes."""
    rng = np.random.default_rng([seed, 1])
    kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    among = [name for name, cause in CAUSES.items() if cause.kind == ("known" if kind == "pair" else kind)]
    chosen = rng.choice(among, 2 if kind == "pair" else 1, replace=False)
    return draw_plan(seed, tuple(str(one) for one in chosen), site=site)


def simulate_run(plan: Plan, name: str, causes: Mapping[str, Mapping[str, float]]) -> tuple[dict[str, Floats], Floats]:
    """One run's true channels (SI, `time` among them) with some of the plan's causes, and what the encoder truly reads."""
    site, run = plan.site, plan.site.runs[name]
    p = site.tower._replace(**plan.plant)
    for cause, values in causes.items():
        p = p._replace(**{to: values[which] for which, to in CAUSES[cause].fields.items()})
    p = p.with_sheave(run.share)
    excitation = excitation_of_trip(p, *trip(run.start, run.stop, site.limits, STEP, site.every, plan.before))
    rng = np.random.default_rng([plan.seed, 2, list(site.runs).index(name)])
    for cause, values in causes.items():
        act = CAUSES[cause].excitation
        excitation = act(p, excitation, values, rng) if act else excitation
    true = simulate(p, excitation, sensors(plan, causes), site.every)
    recorded = true["time"] >= 0.0
    car = -excitation.encoder * excitation.ends[:: site.every, 0, 0]
    return {name: values[recorded] for name, values in true.items()}, car[recorded]


def sensors(plan: Plan, causes: Mapping[str, Mapping[str, float]]) -> dict[str, tuple[float, float]]:
    """Side and height of each sensor; one of them may be mounted higher than the model file says."""
    found = dict(plan.site.sensors)
    if "sensor_height" in causes and plan.column:
        name = plan.site.channels[plan.column].source
        side, height = found[name]
        found[name] = (side, height + causes["sensor_height"]["error"])
    return found


def measured(plan: Plan, true: Mapping[str, Floats], car: Floats, causes: Mapping[str, Mapping[str, float]]) -> faults.Rows:
    """What the instruments make of it, without noise, in the units of the files; displacements from rest."""
    rows = {"time": true["time"], "car_position": car}
    resting = true["time"] < plan.site.limits.rest - AFOOT
    for column, channel in plan.site.channels.items():
        values = true[channel.source]
        if channel.reference == "rest":
            values = values - values[resting].mean()
        for cause, by in causes.items():
            fault = CAUSES[cause].channel
            values = fault(true["time"], values, by) if fault and column == plan.column else values
        rows[column] = values * channel.scale
    return rows


def noisy(plan: Plan, rows: faults.Rows, rng: np.random.Generator) -> faults.Rows:
    """Rows as they are written: faults of clocks, noise, outliers, gaps."""
    for fault in (faults.uneven_sampling, faults.clock_offset):
        if fault.__name__ in plan.causes:
            rows = fault(rows, plan.causes[fault.__name__], rng)
    noise = plan.site.noise
    phi = plan.correlation
    rows = {
        name: values
        if name == "time"
        else values + filtered(rng.normal(0.0, noise.get(name, plan.site.encoder), len(values)), 0.0 if name == CAR else phi)
        for name, values in rows.items()
    }
    if "outliers" in plan.causes:
        rows = faults.outliers(rows, plan.causes["outliers"], rng, noise)
    return faults.gaps(rows, plan.causes["gaps"], rng) if "gaps" in plan.causes else rows


def filtered(white: Floats, phi: float) -> Floats:
    """Noise of the same variance whose samples are correlated by `phi` with the ones before."""
    if phi == 0.0:
        return white
    return lfilter([1.0], [1.0, -phi], np.concatenate([white[:1], np.sqrt(1.0 - phi**2) * white[1:]]))


def write(plan: Plan, folder: Path) -> None:
    """Drive all runs and write the campaign and its truth."""
    folder.mkdir(parents=True, exist_ok=True)
    shift: dict[str, float] = {}
    site = plan.site
    lightest = min(site.runs, key=lambda name: site.runs[name].share)  # where causes show most
    for k, name in enumerate(site.runs):
        rows = measured(plan, *simulate_run(plan, name, plan.causes), plan.causes)
        if name == lightest and plan.kind != "nothing":
            shift = shifted(site, rows, measured(plan, *simulate_run(plan, name, {}), {}))
        campaign_files.table(folder / f"{name}.csv", noisy(plan, rows, np.random.default_rng([plan.seed, 3, k])))
    campaign_files.describe(folder, site, plan.seed, stated_noise(plan) if plan.stated else None)
    truth = {
        "site": site.name, "kind": plan.kind, "causes": plan.causes, "column": plan.column, "level": plan.level,
        "seed": plan.seed, "before": plan.before, "plant": plan.plant, "near": near(plan), "shift": shift,
        "effects": {CAUSES[name].effect or name: values for name, values in plan.causes.items()},
    }  # fmt: skip
    (folder / "truth.json").write_text(json.dumps(truth, indent=1) + "\n", encoding="utf-8")


def stated_noise(plan: Plan) -> float:
    """The noise that campaign.toml states over the true one."""
    return plan.causes.get("wrong_noise", {}).get("stated_over_true", 1.0)


def near(plan: Plan) -> list[str]:
    """Effects of the library that come close to a hidden cause outside it."""
    return sorted({name for cause in plan.causes for name in CAUSES[cause].near})


def shifted(site: Site, rows: faults.Rows, plain: faults.Rows) -> dict[str, float]:
    """By how many times its noise the causes shift each channel at most."""
    return {name: float(np.nanmax(np.abs(rows[name] - plain[name])) / size) for name, size in site.noise.items()}
