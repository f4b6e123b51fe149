"""A thousand random bad inputs: every one must end in a clear error, none in a crash or in a NaN passed on.

    python benchmarks/bad_inputs.py [--count 1000] [--seed 1]

A quarter each: parameters out of range or not numbers, inputs that are not numbers or out of reach, step
sizes and times that cannot be, all through fmpy on the rope's FMU; and model files broken at random. A
case passes when it is refused with a sentence, or, where a change happens to be harmless, when every
output stays finite.
"""

import argparse
import contextlib
import io
import math
import random
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import fmpy

from comprope.errors import CompropeError
from comprope.rope.model_file import load
from comprope_system.presets import model_path
from comprope_system.simulation.cosim.fmu_cache import rope_fmu
from comprope_system.simulation.cosim.fmu_participant import FmuParticipant

ODD = (math.nan, math.inf, -math.inf, -1.0, 0.0, 1e300, -1e300, 1e-300)
Outcome = str


class Rope:
    """The rope's FMU, a fresh instance for each case."""

    def __init__(self) -> None:
        self.path = rope_fmu(4)
        variables = fmpy.read_model_description(str(self.path)).modelVariables
        self.parameters = [one for one in variables if one.causality == "parameter" and one.type == "Real"]
        self.inputs = [one.name for one in variables if one.causality == "input"]

    def run(self, start: dict[str, float], steps: list[tuple[float, float, dict[str, float]]]) -> Outcome:
        """Start with values, then make steps of (time, length, inputs); "refused" or "finite", else what went wrong."""
        silent = io.StringIO()
        try:
            with contextlib.redirect_stderr(silent), FmuParticipant("rope", self.path, start) as rope:
                rope.prepare(0.0)
                rope.begin()
                for time, dt, inputs in steps:
                    rope.set(inputs)
                    rope.step(time, dt)
                finite = all(math.isfinite(float(value)) for value in rope.outputs().values())
        except CompropeError as error:
            return "refused" if len(str(error)) > 20 else f"unclear: {error}"
        return "finite" if finite else "NaN passed on"


def odd_parameters(rope: Rope, rng: random.Random) -> Outcome:
    """One to three parameters far from what is accepted."""
    chosen = rng.sample(rope.parameters, rng.randint(1, 3))
    start = {
        one.name: rng.choice([*ODD, float(one.max or 1.0) * rng.uniform(1.1, 1e3), -rng.uniform(0.0, 1e6)]) for one in chosen
    }
    return rope.run(start, [(0.0, 0.01, {})])


def odd_inputs(rope: Rope, rng: random.Random) -> Outcome:
    """Inputs that are no numbers, or ends where no rope reaches, or jumps."""
    steps = [(0.01 * k, 0.01, {}) for k in range(rng.randint(0, 3))]
    name = rng.choice(rope.inputs)
    bad = rng.choice([*ODD, rng.uniform(-500.0, 2000.0), rng.uniform(-3.0, 60.0)])
    return rope.run({}, [*steps, (0.01 * len(steps), 0.01, {name: bad}), (0.01 * (len(steps) + 1), 0.01, {})])


def odd_steps(rope: Rope, rng: random.Random) -> Outcome:
    """Step sizes and times that cannot be, or are huge or tiny."""
    dt = rng.choice([*ODD, rng.uniform(-1.0, 0.0), 10.0 ** rng.uniform(-12, -6), 10.0 ** rng.uniform(6, 12)])
    time = rng.choice([0.01, 0.01, math.nan, -1.0, rng.uniform(0.02, 100.0)])
    return rope.run({}, [(0.0, 0.01, {}), (time, dt, {})])


def broken_file(rope: Rope, rng: random.Random) -> Outcome:
    """A model file with lines lost, doubled, cut, or with other values."""
    lines = model_path("tower50").read_text(encoding="utf-8").splitlines()
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(lines))
        lines[at] = rng.choice(BREAKS)(lines[at], rng)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.toml"
        path.write_text("\n".join(lines), encoding="utf-8")
        try:
            load(path)
        except CompropeError as error:
            return "refused" if "model.toml" in str(error) else f"unclear: {error}"
    return "finite"


BREAKS: tuple[Callable[[str, random.Random], str], ...] = (
    lambda line, rng: "",
    lambda line, rng: f"{line}\n{line}",
    lambda line, rng: line[: rng.randint(0, len(line))],
    lambda line, rng: f"{line.split('=')[0]}= {rng.choice(['nan', 'inf', '-1e9', 'true', '[1, 2]', '{}', 'x', '1e400'])}",
    lambda line, rng: line.replace("a", "e"),
    lambda line, rng: "".join(rng.sample(line, len(line))),
)
CASES = (odd_parameters, odd_inputs, odd_steps, broken_file)


def main() -> None:
    """Run all cases and print how they ended."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--count", type=int, default=1000)
    options.add_argument("--seed", type=int, default=1)
    chosen = options.parse_args()
    rng, rope = random.Random(chosen.seed), Rope()
    ends: dict[str, Counter[str]] = {case.__name__: Counter() for case in CASES}
    for k in range(chosen.count):
        case = CASES[k % len(CASES)]
        try:
            ends[case.__name__][case(rope, rng)] += 1
        except Exception as error:  # anything else than a clear refusal is what this looks for
            ends[case.__name__][f"{type(error).__name__}: {error}"] += 1
    for name, counter in ends.items():
        print(f"{name:16s}", ", ".join(f"{count} {end}" for end, count in counter.most_common()))


if __name__ == "__main__":
    main()
