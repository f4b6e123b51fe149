"""Builds the binary of the FMUs that run in Python, for every system, from its C sources:

    python -m comprope.native.python_binary

replaces those in `fmi/binary`, which are part of the package, so that nobody needs a compiler to build such an FMU.
"""

from ..atomic_files import atomic_write
from ..fmi.package import BINARIES, BINARY
from .fmi2_package import binary_files
from .linker import C_SOURCES, link
from .targets import TARGETS

NAME = "python_slave"
# Those of the sources of native FMUs that it has as well.
_SHARED = ("fmi2_functions.c", "calls.h", "value_type.h", "variables.h", "message.c", "message.h")


def python_binaries() -> dict[str, bytes]:
    """The binary by system, as in `package.BINARIES`; the same compiler gives the same bytes."""
    own = [path for path in BINARY.iterdir() if path.suffix in (".c", ".h")]
    files = {path.name: path.read_bytes() for path in (*own, *(C_SOURCES / name for name in _SHARED))}
    chosen = {name: target for name, target in TARGETS.items() if target.folder in BINARIES}
    made = {name: link(NAME, files, target, [] if target.extension == "dll" else ["-ldl"]) for name, target in chosen.items()}
    return {path.split("/")[1]: content for path, content in binary_files(NAME, made).items()}


if __name__ == "__main__":
    for system, content in python_binaries().items():
        with atomic_write(BINARY / f"{system}.{BINARIES[system]}") as path:
            path.write_bytes(content)
