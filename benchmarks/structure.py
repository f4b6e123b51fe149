"""Structure of the source code, read from its own imports: `python benchmarks/structure.py [CHECKOUT] [--all]`.

For each package: Python files in it, floors (files and sub-packages on the longest chain of imports inside it), arrows (pairs of
files or direct sub-packages of which one imports the other) and circles (groups that import each other). Then the longest
argument lists, the functions over 50 lines and the files over 300 lines. A checkout is a folder with `fmu_src` and `system`.
"""

import argparse
import ast
import sys
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

FOLDERS = ("fmu_src", "system")
LIMITS = {"arguments": 8, "function lines": 50, "file lines": 300}


@dataclass
class Module:
    """One Python file: its dotted name, its syntax tree and the modules of the project that it imports."""

    name: str
    path: Path
    tree: ast.Module
    imports: set[str] = field(default_factory=set)


def read_modules(checkout: Path) -> dict[str, Module]:
    """Every module below the source folders, with its imports resolved to modules of the project."""
    modules = {}
    for folder in FOLDERS:
        for path in sorted((checkout / folder).rglob("*.py")):
            parts = path.relative_to(checkout / folder).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            modules[name] = Module(name, path, ast.parse(path.read_text(encoding="utf-8")))
    for module in modules.values():
        module.imports = {name for found in _targets(module) if (name := _resolved(found, modules)) and name != module.name}
    return modules


def _targets(module: Module) -> list[str]:
    """Absolute dotted names that a module imports, anywhere in it; `from a import b` gives `a.b`."""
    package = module.name.split(".") if module.path.name == "__init__.py" else module.name.split(".")[:-1]
    found = []
    for node in ast.walk(module.tree):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            origin = ".".join([*base, *([node.module] if node.module else [])])
            found += [f"{origin}.{alias.name}" for alias in node.names]
    return found


def _resolved(target: str, modules: dict[str, Module]) -> str | None:
    """The module that defines `target`: itself, or the module one name above; None outside the project."""
    return next((name for name in (target, target.rpartition(".")[0]) if name in modules), None)


def packages(modules: dict[str, Module]) -> list[str]:
    """Names of the packages: modules that hold others, in order."""
    return sorted({name.rpartition(".")[0] for name in modules if "." in name})


def arrows_inside(package: str, modules: dict[str, Module]) -> dict[str, set[str]]:
    """Imports between the direct members of a package (files and sub-packages): importer -> imported members."""
    members: dict[str, set[str]] = defaultdict(set)
    for module in modules.values():
        source = _member(package, module.name)
        if source is None:
            continue
        members[source] |= {target for name in module.imports if (target := _member(package, name)) not in (None, source)}
    return {source: targets | set() for source, targets in members.items()}


def _member(package: str, name: str) -> str | None:
    """The direct member of `package` that module `name` belongs to (`__init__` for the package itself), None outside it."""
    if name == package:
        return "__init__"
    return name[len(package) + 1 :].split(".")[0] if name.startswith(package + ".") else None


def circles(arrows: dict[str, set[str]]) -> list[set[str]]:
    """Groups of members that import each other, directly or through others."""
    reach = {member: _reachable(member, arrows) for member in arrows}
    groups = {frozenset({member} | {other for other in reach[member] if member in reach.get(other, set())}) for member in arrows}
    return [set(group) for group in groups if len(group) > 1]


def _reachable(start: str, arrows: dict[str, set[str]]) -> set[str]:
    seen: set[str] = set()
    waiting = list(arrows.get(start, ()))
    while waiting:
        member = waiting.pop()
        if member not in seen:
            seen.add(member)
            waiting += arrows.get(member, ())
    return seen


def floors(arrows: dict[str, set[str]]) -> list[str]:
    """The longest chain of imports between members, lowest first; a circle counts as one member."""
    group = {member: min(found) for found in circles(arrows) for member in found}
    merged: dict[str, set[str]] = defaultdict(set)
    for member, targets in arrows.items():
        source = group.get(member, member)
        merged[source] |= {group.get(target, target) for target in targets} - {source}
    chains: dict[str, list[str]] = {}

    def chain(member: str) -> list[str]:
        if member not in chains:
            chains[member] = [*max((chain(target) for target in sorted(merged.get(member, ()))), key=len, default=[]), member]
        return chains[member]

    return max((chain(member) for member in sorted(merged)), key=len, default=[])


def functions(modules: dict[str, Module]) -> list[tuple[str, int, int]]:
    """(where, arguments, lines) of every function and method; `self` and `cls` are not counted."""
    found = []
    for module in modules.values():
        for node in ast.walk(module.tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                given = node.args
                names = [a.arg for a in (*given.posonlyargs, *given.args, *given.kwonlyargs, given.vararg, given.kwarg) if a]
                count = len([name for name in names if name not in ("self", "cls")])
                found.append((f"{module.name}:{node.name}", count, (node.end_lineno or node.lineno) - node.lineno + 1))
    return found


def print_packages(modules: dict[str, Module], show_chains: bool) -> None:
    """Table of the packages, one line each, and the members of every circle."""
    print(f"{'package':52} {'files':>5} {'floors':>6} {'arrows':>6} {'circles':>7}")
    for package in packages(modules):
        arrows = arrows_inside(package, modules)
        files = sum(1 for module in modules.values() if module.path.parent == _folder(package, modules))
        found = circles(arrows)
        chain = floors(arrows)
        print(f"{package:52} {files:5} {len(chain):6} {sum(len(t) for t in arrows.values()):6} {len(found):7}")
        if show_chains:
            print(f"    {' < '.join(chain)}")
        for group in found:
            print(f"    circle: {', '.join(sorted(group))}")


def _folder(package: str, modules: dict[str, Module]) -> Path:
    child = next(module for name, module in modules.items() if name.rpartition(".")[0] == package)
    return child.path.parent.parent if child.path.name == "__init__.py" else child.path.parent


def print_limits(modules: dict[str, Module], everything: bool) -> None:
    """The longest argument lists, the functions and the files over their limits."""
    found = functions(modules)
    by_arguments = sorted(found, key=lambda one: -one[1])
    over = [one for one in by_arguments if one[1] > LIMITS["arguments"]]
    print(f"\nfunctions: {len(found)}; over {LIMITS['arguments']} arguments: {len(over)}; longest argument lists:")
    for where, arguments, _ in over if everything and over else by_arguments[:5]:
        print(f"{arguments:6} {where}")
    long_functions = sorted((one for one in found if one[2] > LIMITS["function lines"]), key=lambda one: -one[2])
    print(f"functions over {LIMITS['function lines']} lines: {len(long_functions)}")
    for where, _, lines in long_functions:
        print(f"{lines:6} {where}")
    sizes = {module.name: len(module.path.read_text(encoding="utf-8").splitlines()) for module in modules.values()}
    large = sorted((name for name, lines in sizes.items() if lines > LIMITS["file lines"]), key=lambda name: -sizes[name])
    print(f"files: {len(sizes)}, lines: {sum(sizes.values())}; files over {LIMITS['file lines']} lines: {len(large)}")
    for name in large:
        print(f"{sizes[name]:6} {name}")


def main() -> int:
    """Print the structure of one checkout."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("checkout", nargs="?", type=Path, default=Path(__file__).resolve().parents[1])
    parser.add_argument("--all", action="store_true", help="also the longest chain of every package and every long argument list")
    given = parser.parse_args()
    modules = read_modules(given.checkout)
    if not modules:
        print(f"{given.checkout}: holds neither {' nor '.join(FOLDERS)}")
        return 1
    print_packages(modules, given.all)
    print_limits(modules, given.all)
    return 0


if __name__ == "__main__":
    sys.exit(main())
