"""Tuning constants of the identification and of its results are declared in one package, each with unit, meaning and origin."""

import ast
import dataclasses
from pathlib import Path

import pytest

from comprope_system import identification, identification_results
from comprope_system.identification.settings import GROUPS, settings_of

FOLDERS = [Path(package.__file__).parent for package in (identification, identification_results)]
ALLOWED = {
    ("residuals/force_probe_effect.py", "MOST"),  # bound of a declared quantity, in a file that stands alone as a user's effect
    # The layout of printed text and pages:
    ("reporting/texts/formatting.py", "WIDTH"),
    ("reporting/texts/formatting.py", "ZERO"),
    ("reporting/run_curves.py", "BAND"),
    ("reporting/tables.py", "SHOWN"),
    ("reporting/pages/diagnosis.py", "RUNS_SHOWN"),
    ("reporting/pages/evidence.py", "LEAST"),
    ("reporting/pages/evidence.py", "SHOWN"),
    ("result/diagnosis.py", "RUNS"),
}


def is_number(node):
    """Whether an expression is made of numbers alone: a literal, a tuple of such, arithmetic or a numpy call on such."""
    match node:
        case ast.Constant(value=value):
            return isinstance(value, int | float) and not isinstance(value, bool)
        case ast.UnaryOp(operand=one):
            return is_number(one)
        case ast.BinOp(left=a, right=b):
            return is_number(a) and is_number(b)
        case ast.Tuple(elts=parts) | ast.List(elts=parts) | ast.Call(args=parts):
            return bool(parts) and all(is_number(one) for one in parts)
    return False


def numeric_constants(source):
    """Names that are assigned at the top of a module a value made of numbers."""
    for node in ast.parse(source).body:
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        if targets and node.value is not None and is_number(node.value):
            yield from (one.id for target in targets for one in ast.walk(target) if isinstance(one, ast.Name))


@pytest.mark.parametrize(
    "line", ["A = 3", "A, B = 0.1, -2.0", "A: float = 1e-3", "A = np.arange(0.5, 6.0, 0.1)", "A = (1.0, 2 * 3)"]
)
def test_a_numeric_constant_is_recognised(line):
    assert "A" in set(numeric_constants(line))


def test_no_other_module_defines_a_tuning_constant():
    files = [(root, path) for root in FOLDERS for path in root.rglob("*.py") if path.parent.name != "settings"]
    assert len(files) > 30
    found = {
        (path.relative_to(root).as_posix(), name) for root, path in files for name in numeric_constants(path.read_text("utf-8"))
    }
    assert found == ALLOWED


@pytest.mark.parametrize("group", GROUPS, ids=lambda group: type(group).__name__)
def test_every_constant_has_a_unit_a_meaning_and_an_origin(group):
    for one in settings_of(group):
        assert one.unit and len(one.decides) > 10 and len(one.origin) > 3, one
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(group, next(settings_of(group)).name, 0.0)
