"""Workflow of `comprope verify`: run the checks, draw their figures, write one page."""

import importlib
import sys
from collections.abc import Sequence
from pathlib import Path

from comprope.atomic_files import require_writable
from comprope.errors import CompropeError, InputError
from comprope.validation_messages import suggestion

from ...report.comparison_report import ComparisonReport
from ...report.page import Section, save_page, save_pictures
from .check import PASS, Check, verdicts

NAMES = ("reference", "offset", "periods", "capstan", "shortening", "convergence", "invariants")
PAGE = "verification.html"
TITLE = "Compensation rope: verification of the numerics"
LEAD = (
    "Are the equations of the rope solved correctly? Comparison with another program and closed-form solutions, convergence in "
    "mesh and time step, and invariants."
)


def run(names: Sequence[str], out: Path) -> dict[str, ComparisonReport]:
    """Run checks by name (all if none) and write figures and page; raises `CompropeError` at the end if one has failed."""
    checks = [find(name) for name in names or NAMES]
    require_writable(out / PAGE)
    reports = {}
    for check in checks:
        reports[check.name] = check.run()
        for fact in reports[check.name].comparisons:
            sys.stdout.write(f"{fact.verdict:<5} {fact.what}: expected {fact.stated}; obtained {fact.obtained}\n")
    sections = [check.section(reports[check.name]) for check in checks]
    comparisons = [fact for comparison_report in reports.values() for fact in comparison_report.comparisons]
    save_pictures(out, sections)
    save_page(out / PAGE, TITLE, LEAD, [Section("summary", "Summary", [verdicts(comparisons)]), *sections])
    sys.stdout.write(f"written {out / PAGE}\n")
    if failed := [fact.what for fact in comparisons if fact.verdict != PASS]:
        raise CompropeError(f"verification: {len(failed)} of {len(comparisons)} checks failed: {'; '.join(failed)}")
    return reports


def find(name: str) -> Check:
    """The check of a name; raises `InputError` for another name."""
    if name not in NAMES:
        raise InputError(f"{name}: not a check; {suggestion(name, list(NAMES))}")
    check: Check = importlib.import_module(f"{__package__}.{name}").CHECK
    return check
