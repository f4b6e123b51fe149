"""Small faults put into the sources one at a time: each must make one of the tests named for it fail.

    python benchmarks/mutants.py [--jobs N] [NAME...]

runs all mutants of `mutants_table`, or those whose names begin with one of the names given. Each is applied to a copy of the
sources in a temporary folder; the tests run there, kernels without a compiler (`COMPROPE_PURE_PYTHON=1`), so that a mutant costs
seconds. A mutant is killed if a test fails, and has survived if all pass; a text that is not found, or not once, is an error, as
is a mutant that cannot be imported. The tests run on the unchanged copy first: what fails there would kill everything.

Each run of tests is a fork of this process, which has imported the libraries but nothing of the project; Linux and macOS only.
"""

import argparse
import compileall
import importlib
import os
import re
import resource
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from mutants_table import MUTANTS, Mutant

ROOT = Path(__file__).parents[1]
PARTS = ("fmu_src", "system", "tests", "docs", "pyproject.toml")
LIMIT = 120  # s of processor time for the tests of one mutant; one that never ends is killed by that
PASSED, FAILED, ENDLESS = 0, 1, 2  # of a run of tests; what pytest returns, or more
# Libraries that tests import: once here instead of once for each mutant.
LIBRARIES = (
    "numpy", "scipy.interpolate", "scipy.linalg", "scipy.optimize", "scipy.signal", "scipy.special", "scipy.sparse", "numba",
    "numba.extending", "pydantic", "pandas", "control", "rich.progress", "matplotlib.pyplot", "hypothesis", "fmpy", "pythonfmu",
)  # fmt: skip


@dataclass
class Job:
    """Tests to run in a copy, with or without the compiler, on the sources as they are or with a mutant in them."""

    name: str
    tests: Sequence[str]
    without_compiler: bool
    mutant: Mutant | None = None
    status: int = PASSED
    output: str = ""
    problem: str = ""
    seconds: float = field(default=0.0)

    @property
    def by(self) -> str:
        """The first test that failed."""
        failed = re.search(r"^(?:FAILED|ERROR) tests/(\S+)", self.output, re.MULTILINE)
        return failed[1] if failed else ""

    @property
    def outcome(self) -> str:
        """What became of a mutant: "killed", "survived", or what is wrong with it."""
        if self.problem:
            return f"not applicable: {self.problem}"
        known = {PASSED: "survived", FAILED: "killed", ENDLESS: f"killed, no end within {LIMIT} s"}
        return known.get(self.status, f"broken: pytest ends with {self.status}")

    def line(self) -> str:
        """Name, outcome, first test that failed, and processor time."""
        return f"{self.name:52s} {self.outcome:9s} {self.seconds:6.1f} s  {self.by}"


def main() -> None:
    """Run the mutants asked for; exits with 1 unless all were killed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="beginnings of names; all mutants without one")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="mutants at once")
    given = parser.parse_args()
    chosen = [one for one in MUTANTS if not given.names or one.name.startswith(tuple(given.names))]
    if not chosen:
        parser.error(f"no mutant has a name that begins with {' or '.join(given.names)}")
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        folders = copies(Path(folder), given.jobs)
        for name in LIBRARIES:
            importlib.import_module(name)
        for job in run_all(unchanged(chosen), folders):
            if job.status != PASSED:
                sys.exit(f"{job.name}: {job.by or job.outcome}\n{job.output[-2000:]}")
        jobs = [Job(one.name, one.tests, one.in_kernels, one) for one in chosen]
        for _ in run_all(jobs, folders):
            pass
    report(jobs, time.monotonic() - begun)
    sys.exit(any(not one.outcome.startswith("killed") for one in jobs))


def copies(folder: Path, number: int) -> list[Path]:
    """Copies of sources and tests in a folder, with their bytecode."""
    first = folder / "0"
    first.mkdir()
    for name in PARTS:
        source, target = ROOT / name, first / name
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
        else:
            shutil.copy2(source, target)
    for name in ("fmu_src", "system"):
        compileall.compile_dir(first / name, quiet=1)
    for k in range(1, number):
        shutil.copytree(first, folder / str(k))
    return [folder / str(k) for k in range(number)]


def unchanged(mutants: Sequence[Mutant]) -> list[Job]:
    """Every test that the mutants name, file by file, without a mutant."""
    groups: dict[tuple[str, bool], list[str]] = {}
    for one in mutants:
        for test in one.tests:
            tests = groups.setdefault((test.partition("::")[0], one.in_kernels), [])
            tests += [test] if test not in tests else []
    return [Job(f"{file}, no mutant", tests, in_kernels) for (file, in_kernels), tests in groups.items()]


def run_all(jobs: Sequence[Job], folders: Sequence[Path]) -> Iterator[Job]:
    """Run jobs, one in each folder at a time; gives them as they end and prints how far it is."""
    begun, idle, running, left, done = time.monotonic(), list(folders), {}, list(jobs)[::-1], 0
    while left or running:
        while left and idle:
            job, folder = left.pop(), idle.pop()
            running[start(job, folder)] = job, folder
        process, status, usage = os.wait4(-1, 0)
        job, folder = running.pop(process)
        finish(job, folder, status, usage)
        idle.append(folder)
        done += 1
        minutes = (time.monotonic() - begun) / done * (len(jobs) - done) / 60.0
        print(f"{done:3d} of {len(jobs)}, about {minutes:.0f} min left: {job.line()}", flush=True)
        yield job


def start(job: Job, folder: Path) -> int:
    """Apply a job's mutant in a folder and run its tests there in a fork; returns the process."""
    if job.mutant:
        try:
            file, text = mutated(job.mutant, folder)
            (folder / "original").write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
            (folder / "changed").write_text(str(file), encoding="utf-8")
            file.write_text(text, encoding="utf-8")
        except LookupError as error:
            job.problem = error.args[0]
    process = os.fork()
    if process:
        return process
    status = PASSED
    try:
        if not job.problem:
            status = run_tests(job, folder)
    finally:
        os._exit(status)


def run_tests(job: Job, folder: Path) -> int:
    """Run a job's tests in this process, which ends with it; returns what pytest returns."""
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    os.chdir(folder)
    os.environ |= {"OPENBLAS_NUM_THREADS": "1", "COMPROPE_PURE_PYTHON": "1" if job.without_compiler else "0"}
    os.environ["PYTHONPATH"] = os.pathsep.join(str(folder / name) for name in ("fmu_src", "system"))
    sys.path[:0] = [str(folder / "fmu_src"), str(folder / "system")]
    sys.dont_write_bytecode = True
    for stream in (1, 2):
        os.dup2(os.open(folder / "output", os.O_WRONLY | os.O_CREAT | (os.O_TRUNC if stream == 1 else os.O_APPEND)), stream)
    options = ["-x", "-q", "--no-header", "--tb=no", "-rfE", "-W", "ignore", "-p", "no:cacheprovider"]
    status = int(pytest.main([*options, *(f"tests/{test}" for test in job.tests)]))
    sys.stdout.flush()
    return status


def finish(job: Job, folder: Path, status: int, usage: resource.struct_rusage) -> None:
    """Take the mutant back and note what the tests have shown."""
    job.status = os.waitstatus_to_exitcode(status)
    job.status = ENDLESS if job.status < 0 else 3 if job.status == ENDLESS else job.status
    job.seconds = usage.ru_utime + usage.ru_stime
    with suppress(FileNotFoundError):
        job.output = (folder / "output").read_text(encoding="utf-8", errors="replace")
        (folder / "output").unlink()
    with suppress(FileNotFoundError):
        Path((folder / "changed").read_text(encoding="utf-8")).write_text((folder / "original").read_text(encoding="utf-8"))
        (folder / "changed").unlink()


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


def report(jobs: Sequence[Job], elapsed: float) -> None:
    """Print a table of all mutants, how many of each part of the program were killed, and the time."""
    for one in jobs:
        print(one.line())
    for area in dict.fromkeys(one.mutant.area for one in jobs if one.mutant):
        own = [one.outcome.startswith("killed") for one in jobs if one.mutant and one.mutant.area == area]
        print(f"{area:15s} {sum(own):3d} of {len(own):3d} killed")
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    killed = sum(one.outcome.startswith("killed") for one in jobs)
    processor = (children.ru_utime + children.ru_stime) / 60.0
    print(f"{killed} of {len(jobs)} killed in {elapsed / 60.0:.1f} min, {processor:.1f} min of processor time")
    for one in jobs:
        if not one.outcome.startswith("killed"):
            print(f"NOT KILLED: {one.line()}")


if __name__ == "__main__":
    main()
