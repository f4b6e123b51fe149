"""Build an FMU that runs in Python: a binary, a copy of this code, and the model description; the result is reproducible.

The copy of the code has the hash of its content in its name. A Python process identifies a module by its name alone, so two
FMUs, or two builds of one, would otherwise run whichever code was loaded first.
"""

import ast
import hashlib
import subprocess
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib import metadata
from io import BytesIO
from pathlib import Path

from ..atomic_files import atomic_write
from ..errors import CompropeError, InputError
from .documentation import documentation_page
from .icon import icon
from .model_description import complete_description
from .model_interface import ModelInterface
from .pythonfmu_slave import pythonfmu_description
from .validation import interface_problems

COMPROPE = Path(__file__).parent.parent
# The modules of this package that run inside an FMU.
FMI_MODULES = (
    "__init__", "arrays", "component", "error_reporting", "functions", "instance", "model_interface", "units", "validation",
)  # fmt: skip
FIXED_TIME = (1980, 1, 1, 0, 0, 0)
DESCRIPTION = "modelDescription.xml"

# The binary by system, and where FMI has its place.
BINARY = COMPROPE / "fmi" / "binary"
BINARIES = {"linux64": "so", "win64": "dll", "darwin64": "dylib"}
GUID_FILE = "resources/guid.txt"

_BUNDLED_MODULE = '''\
"""The model of this FMU, made from the files beside this one; written by comprope."""

from pathlib import Path

HERE = Path(__file__).parent

{entry}
'''

_LOADER = '''\
"""Loads the code of this FMU for its binary, which defines RESOURCES, TABLE, PROBLEM and PROBLEM_SIZE. Written by comprope."""

import ctypes
import importlib.util
import os
import sys

NAME, PACKAGE = "{name}", "{package}"


def functions():
    """The functions of the FMI for this FMU; the package is loaded once, for all FMUs with this code."""
    if PACKAGE not in sys.modules:
        folder = os.path.join(RESOURCES, PACKAGE)
        spec = importlib.util.spec_from_file_location(
            PACKAGE, os.path.join(folder, "__init__.py"), submodule_search_locations=[folder]
        )
        sys.modules[PACKAGE] = package = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(package)
            package.interface = importlib.import_module(PACKAGE + ".bundled").INTERFACE
            package.make = importlib.import_module(PACKAGE + ".fmi.functions").Functions
            package.by_guid = {{}}
        except BaseException:
            for module in [one for one in sys.modules if one == PACKAGE or one.startswith(PACKAGE + ".")]:
                del sys.modules[module]
            raise
    package = sys.modules[PACKAGE]
    with open(os.path.join(RESOURCES, "guid.txt"), encoding="ascii") as file:
        guid = file.read()
    if guid not in package.by_guid:
        package.by_guid[guid] = package.make(package.interface, NAME + " of " + PACKAGE, guid)
    return package.by_guid[guid]


try:
    pointers = functions().pointers
    ctypes.memmove(TABLE, pointers, ctypes.sizeof(pointers))
except BaseException as error:
    text = "%s cannot be loaded: %s: %s. It needs {needs}." % (NAME, type(error).__name__, " ".join(str(error).split()))
    data = text.encode("utf-8", "replace")[: PROBLEM_SIZE - 1] + bytes(1)
    ctypes.memmove(PROBLEM, data, len(data))
'''


@dataclass(frozen=True)
class Origin:
    """Version and licence written into an FMU, and the oldest Python that runs it."""

    version: str
    licence: str
    python: str = "3.11"


@dataclass(frozen=True)
class Bundle:
    """The files of a Python package by path; the package is named by their content."""

    stem: str
    files: Mapping[str, bytes] = field(repr=False)

    @property
    def digest(self) -> str:
        """The first eight digits of the hash of all files."""
        return digest(self.files)[:8]

    @property
    def needs(self) -> str:
        """The packages that the code imports besides Python's own and the FMU's, as arguments of `pip install`."""
        trees = [ast.parse(content) for path, content in self.files.items() if path.endswith(".py")]
        nodes = [node for tree in trees for node in ast.walk(tree)]
        names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        names |= {node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.module and not node.level}
        foreign = {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"comprope"}
        owners = metadata.packages_distributions()
        return " ".join(sorted({owners.get(name, [name])[0].lower() for name in foreign}))

    @property
    def package(self) -> str:
        """The package's name inside the FMU."""
        return f"{self.stem}_{self.digest}"


def build(
    interface: ModelInterface,
    packages: list[str],
    entry: str,
    out: Path,
    origin: Origin,
    data: Mapping[str, bytes] | None = None,
    root: Path = COMPROPE,
    extra: Mapping[str, bytes] | None = None,
) -> Path:
    """Write `<out>/<name>.fmu` atomically and return its path.

    `packages` are the folders in `root` that the model needs as subpackages of `comprope`, besides `fmi`.
    `entry` is source text that defines INTERFACE inside the copied package, where imports are relative and
    the `data` files lie in the folder HERE. `extra` files go into the FMU by their path there. The same arguments
    give the same bytes.
    Raises `InputError` for an inconsistent interface or a folder that cannot be written.
    """
    if problems := interface_problems(interface):
        raise InputError("; ".join(problems))
    files = _source_files(packages, root) | dict(data or {}) | {"bundled.py": _BUNDLED_MODULE.format(entry=entry).encode()}
    bundle = Bundle("_".join(["comprope", *packages]), files)
    content = _resources(interface.name, bundle, origin)
    _require_loading(content)
    content |= _binary_files(interface.name)
    content |= _documentation_files(interface, origin, bundle.needs) | dict(extra or {})
    xml = pythonfmu_description(interface)
    guid = str(uuid.UUID(digest(content | {DESCRIPTION: complete_description(xml, interface, origin.version, "")})[:32]))
    content |= {DESCRIPTION: complete_description(xml, interface, origin.version, guid), GUID_FILE: guid.encode()}
    with atomic_write(out / f"{interface.name}.fmu") as path:
        path.write_bytes(reproducible_zip(content))
    return out / f"{interface.name}.fmu"


def _source_files(packages: Iterable[str], root: Path) -> dict[str, bytes]:
    """The files to copy: the modules at the top, FMI_MODULES, and whole subpackages."""
    files = {path.name: path.read_bytes() for path in COMPROPE.glob("*.py")}
    files |= {f"fmi/{name}.py": (COMPROPE / "fmi" / f"{name}.py").read_bytes() for name in FMI_MODULES}
    for package in packages:
        inside = (path for path in (root / package).rglob("*") if path.is_file() and "__pycache__" not in path.parts)
        files |= {path.relative_to(root).as_posix(): path.read_bytes() for path in inside}
    return files


def _resources(name: str, bundle: Bundle, origin: Origin) -> dict[str, bytes]:
    """The code and what loads it, by path in the FMU."""
    needs = f"Python {origin.python} or newer and: pip install {bundle.needs}"
    loader = _LOADER.format(name=name, package=bundle.package, needs=needs)
    code = {f"resources/{bundle.package}/{path}": content for path, content in bundle.files.items()}
    return code | {"resources/load.py": loader.encode()}


# What the binary does with load.py.
_LOADING = """\
import ctypes, sys
table, problem = (ctypes.c_void_p * 64)(), ctypes.create_string_buffer(2048)
places = {"RESOURCES": ".", "TABLE": ctypes.addressof(table), "PROBLEM": ctypes.addressof(problem), "PROBLEM_SIZE": 2048}
exec(compile(open("load.py", "rb").read(), "load.py", "exec"), places)
sys.exit(None if table[0] else problem.value.decode())
"""


def _require_loading(resources: Mapping[str, bytes]) -> None:
    """Raise `CompropeError` if the code of the FMU cannot be loaded; in its own process, to keep its imports separate."""
    with tempfile.TemporaryDirectory() as folder:
        for path, content in {**resources, GUID_FILE: b""}.items():
            target = Path(folder) / Path(path).relative_to("resources")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        command = [sys.executable, "-P", "-B", "-c", _LOADING]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
        if result.returncode:
            raise CompropeError((result.stderr.strip().splitlines() or ["the FMU's code cannot be loaded"])[-1])


def _binary_files(name: str) -> dict[str, bytes]:
    """The binary for each system, by path in the FMU."""
    return {f"binaries/{system}/{name}.{end}": (BINARY / f"{system}.{end}").read_bytes() for system, end in BINARIES.items()}


def _documentation_files(interface: ModelInterface, origin: Origin, needs: str) -> dict[str, bytes]:
    return {
        "model.png": icon(interface.icon),
        "documentation/index.html": documentation_page(interface, origin.version, origin.python, needs).encode(),
        "documentation/licenses/license.txt": origin.licence.encode(),
    }


def digest(files: Mapping[str, bytes]) -> str:
    """A hash of all files and their paths, in hexadecimal digits."""
    total = hashlib.sha256()
    for path in sorted(files):
        total.update(path.encode() + b"\0" + hashlib.sha256(files[path]).digest())
    return total.hexdigest()


def reproducible_zip(content: Mapping[str, bytes]) -> bytes:
    """A ZIP file that depends only on its content: sorted, with one date and one set of permissions."""
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for path in sorted(content):
            info = zipfile.ZipInfo(path, FIXED_TIME)
            info.create_system, info.external_attr = 3, 0o644 << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, content[path], compresslevel=9)
    return buffer.getvalue()
