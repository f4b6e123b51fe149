"""Compiled kernels in the user's cache: one folder for each set of sources, numba and Python."""

import hashlib
import sys
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numba

from ..user_cache import entry_folder, verified_files, write_whole

_CONFIG: Any = numba.config
_LOCK = threading.RLock()


def kernel_folder(sources: Iterable[str]) -> Path:
    """Folder for what is compiled from these sources."""
    key = hashlib.sha256("\0".join([*sources, numba.__version__, sys.version]).encode()).hexdigest()[:16]
    return entry_folder("kernels", key)


def source_file(folder: Path, text: str) -> Path:
    """The file in a folder of compiled kernels that has their source, written if it is absent or holds another text."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)  # the cache may have been emptied since
    path = folder / "joined.py"
    if not path.is_file() or path.read_bytes() != text.encode():
        write_whole(path, text)
    return path


@contextmanager
def compiled_files(folder: Path, text: str, function: str) -> Iterator[None]:
    """Within the block numba loads a function of the source file from whole files, or compiles it, in one process at a time."""
    source = source_file(folder, text)
    files = folder / "__pycache__"
    files.mkdir(mode=0o700, exist_ok=True)
    with _LOCK, verified_files(files, f"{source.stem}.{function}-*"):
        # Beside the source, whatever NUMBA_CACHE_DIR names: numba unpickles what it finds there.
        before, _CONFIG.CACHE_DIR = _CONFIG.CACHE_DIR, ""
        try:
            yield
        finally:
            _CONFIG.CACHE_DIR = before
