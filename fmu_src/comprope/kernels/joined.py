"""Entry points of kernels that are joined in one module, compiled once for a machine and kept on disk."""

import sys
import types
from collections.abc import Mapping
from functools import partial
from pathlib import Path

from .disk_cache import compiled_files, source_file
from .entry import Entry
from .entry_source import EntrySource


def joined_module(folder: Path) -> types.ModuleType:
    """An empty module for the kernels whose compiled code is in a folder.

    What is compiled is loaded again by the name of its module, which must not depend on where this package is.
    """
    module = types.ModuleType(f"comprope_joined_{folder.name}")
    sys.modules[module.__name__] = module
    return module


def entries_text(sources: Mapping[str, EntrySource]) -> str:
    """The source of entry points."""
    return "\n".join(one.text for one in sources.values())


def entries_of(module: types.ModuleType, folder: Path, sources: Mapping[str, EntrySource]) -> dict[str, Entry]:
    """The entry points by name, of the kernels that stand in the module."""
    text = entries_text(sources)
    exec(compile(text, source_file(folder, text), "exec"), module.__dict__)
    return {
        name: Entry(getattr(module, f"call_{name}"), source, partial(compiled_files, folder, text, f"call_{name}"))
        for name, source in sources.items()
    }
