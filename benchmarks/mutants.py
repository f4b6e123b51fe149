"""Small faults put into the sources one at a time: each must make one of the tests named for it fail.

    python benchmarks/mutants.py [--jobs N] [NAME...]

runs all mutants of `mutants_table`, or those whose names begin with one of the names given. Each is applied to a copy of the
sources in a temporary folder; the tests run there, kernels without a compiler (`COMPROPE_PURE_PYTHON=1`), so that a mutant costs
seconds. A mutant is killed if a test fails, and has survived if all pass; a text that is not found, or not once, is an error, as
is a mutant that cannot be imported. The tests run on the unchanged copy first: what fails there would kill everything.
"""

import argparse
import os
import queue
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mutants_table import MUTANTS, Mutant

ROOT = Path(__file__).parents[1]
PARTS = ("fmu_src", "system", "tests", "docs", "pyproject.toml")
LIMIT = 300.0  # s for the tests of one mutant; one that never ends is killed by that
PASSED, FAILED = 0, 1  # what pytest returns


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant: "killed", "survived", or what is wrong with it, by which test, in how many seconds."""

    mutant: Mutant
    outcome: str
    by: str
    seconds: float


def main() -> None:
    """Run the mutants asked for; exits with 1 unless all were killed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="beginnings of names; all mutants without one")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="mutants at once")
    given = parser.parse_args()
    chosen = [one for one in MUTANTS if not given.names or one.name.startswith(tuple(given.names))]
    if not chosen:
        parser.error(f"no mutant has a name that begins with {' or '.join(given.names)}")
    verdicts = run_mutants(chosen, given.jobs)
    report(verdicts)
    sys.exit(any(one.outcome != "killed" for one in verdicts))


def run_mutants(mutants: Sequence[Mutant], jobs: int) -> list[Verdict]:
    """The verdicts on some mutants, in their order; raises SystemExit if a test fails without any mutant."""
    begun, found = time.monotonic(), {}
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        folders: queue.SimpleQueue[Path] = queue.SimpleQueue()
        for k in range(jobs):
            folders.put(copied(Path(folder) / str(k)))
        check_unchanged(mutants, folders, jobs)

        def judged(mutant: Mutant) -> Verdict:
            place = folders.get()
            try:
                return judge(mutant, place)
            finally:
                folders.put(place)

        with ThreadPoolExecutor(jobs) as executor:
            for done, future in enumerate(as_completed([executor.submit(judged, one) for one in mutants]), 1):
                verdict = future.result()
                found[verdict.mutant.name] = verdict
                left = (time.monotonic() - begun) / done * (len(mutants) - done)
                print(f"{done} of {len(mutants)}, about {left / 60.0:.0f} min left: {line(verdict)}", flush=True)
    return [found[one.name] for one in mutants]


def copied(folder: Path) -> Path:
    """A copy of the sources and tests in a new folder."""
    folder.mkdir(parents=True)
    for name in PARTS:
        source, target = ROOT / name, folder / name
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
        else:
            shutil.copy(source, target)
    return folder


def check_unchanged(mutants: Sequence[Mutant], folders: "queue.SimpleQueue[Path]", jobs: int) -> None:
    """Run every test that is named on the unchanged copies, with and without the compiler as the mutants do."""
    groups: dict[tuple[bool, str], list[str]] = {}
    for one in mutants:
        for test in one.tests:
            tests = groups.setdefault((one.in_kernels, test.partition("::")[0]), [])
            tests += [test] if test not in tests else []

    def run(group: tuple[bool, str]) -> tuple[int, str]:
        place = folders.get()
        try:
            return pytest(place, groups[group], without_compiler=group[0])
        finally:
            folders.put(place)

    with ThreadPoolExecutor(jobs) as executor:
        for k, (group, (status, by)) in enumerate(zip(groups, executor.map(run, groups), strict=True), 1):
            if status != PASSED:
                sys.exit(f"{group[1]} does not pass without any mutant: {by or f'pytest returns {status}'}")
            print(f"{k} of {len(groups)} files of tests pass without any mutant", flush=True)


def judge(mutant: Mutant, folder: Path) -> Verdict:
    """Apply a mutant in a copy, run its tests, and take it back."""
    begun = time.monotonic()
    try:
        file, changed = mutated(mutant, folder)
    except LookupError as error:
        return Verdict(mutant, f"not applicable: {error.args[0]}", "", 0.0)
    with replaced(file, changed):
        status, by = pytest(folder, mutant.tests, without_compiler=mutant.in_kernels)
    outcome = {PASSED: "survived", FAILED: "killed"}.get(status, f"broken: pytest returns {status}")
    return Verdict(mutant, outcome, by, time.monotonic() - begun)


def mutated(mutant: Mutant, root: Path) -> tuple[Path, str]:
    """The file that a mutant changes and its text then; raises LookupError unless the original is found exactly once."""
    place, found = root / mutant.place, []
    for file in sorted(place.rglob("*.py")) if place.is_dir() else [place] if place.exists() else []:
        text = file.read_text(encoding="utf-8")
        for first, last in parts_of(mutant, text):
            part = text[first:last]
            changed = text[:first] + part.replace(mutant.original, mutant.replacement, 1) + text[last:]
            found += [(file, changed)] * part.count(mutant.original)
    if len(found) != 1:
        where = f"{mutant.place}, {mutant.function}" if mutant.function else mutant.place
        raise LookupError(f"{mutant.original!r} is found {len(found)} times in {where}")
    return found[0]


def parts_of(mutant: Mutant, text: str) -> Iterator[tuple[int, int]]:
    """Where in a text the functions of the mutant's name begin and end; the whole text where it names none."""
    if not mutant.function:
        yield 0, len(text)
        return
    for head in re.finditer(rf"^( *)def {re.escape(mutant.function)}\(", text, re.MULTILINE):
        end = re.compile(rf"^ {{0,{len(head[1])}}}[^\s)]", re.MULTILINE).search(text, head.end())
        yield head.start(), end.start() if end else len(text)


@contextmanager
def replaced(file: Path, text: str) -> Iterator[None]:
    """The file with another text while the context lasts."""
    before = file.read_text(encoding="utf-8")
    file.write_text(text, encoding="utf-8")
    try:
        yield
    finally:
        file.write_text(before, encoding="utf-8")


def pytest(folder: Path, tests: Sequence[str], *, without_compiler: bool) -> tuple[int, str]:
    """What pytest returns for some tests in a copy, and the first one that failed."""
    paths = os.pathsep.join(str(folder / name) for name in ("fmu_src", "system"))
    environment = os.environ | {"PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
    environment |= {"COMPROPE_PURE_PYTHON": "1" if without_compiler else "0"}
    options = ["-x", "-q", "--no-header", "--tb=no", "-rfE", "-p", "no:cacheprovider", "-p", "no:randomly"]
    command = [sys.executable, "-m", "pytest", *options, *(f"tests/{test}" for test in tests)]
    try:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False)
    except subprocess.TimeoutExpired:
        return FAILED, f"no end within {LIMIT:g} s"
    failed = re.search(r"^(?:FAILED|ERROR) tests/(\S+)", done.stdout, re.MULTILINE)
    return done.returncode, failed[1] if failed else ""


def line(verdict: Verdict) -> str:
    """A verdict in one line."""
    by = f" by {verdict.by}" if verdict.by else ""
    return f"{verdict.mutant.name}: {verdict.outcome}{by} ({verdict.seconds:.0f} s)"


def report(verdicts: Sequence[Verdict]) -> None:
    """Print a table of all mutants, and how many of each part of the program were killed."""
    for one in verdicts:
        print(f"{one.mutant.name:44s} {one.outcome:9s} {one.seconds:5.0f} s  {one.by}")
    areas = dict.fromkeys(one.mutant.area for one in verdicts)
    for area in areas:
        own = [one for one in verdicts if one.mutant.area == area]
        print(f"{area:20s} {sum(one.outcome == 'killed' for one in own):3d} of {len(own):3d} killed")
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    killed = sum(one.outcome == "killed" for one in verdicts)
    print(f"{killed} of {len(verdicts)} killed; {(children.ru_utime + children.ru_stime) / 60.0:.1f} min of processor time")
    for one in verdicts:
        if one.outcome != "killed":
            print(f"NOT KILLED: {line(one)}")


if __name__ == "__main__":
    main()
