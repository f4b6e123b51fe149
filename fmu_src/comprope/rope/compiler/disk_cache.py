"""Where compiled kernels are kept on disk."""

import hashlib
import os
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numba


def cache_folder(sources: Iterable[str]) -> Path:
    """Folder for what is compiled from these sources, in the user's cache or, failing that, a temporary one."""
    key = hashlib.sha256("\0".join([*sources, numba.__version__, sys.version]).encode()).hexdigest()[:16]
    for base in (os.environ.get("COMPROPE_CACHE"), _user_cache(), Path(tempfile.gettempdir()) / "comprope"):
        if base:
            folder = Path(base) / key
            try:
                folder.mkdir(parents=True, exist_ok=True)
            except OSError:
                continue
            if os.access(folder, os.W_OK):
                return folder
    return Path(tempfile.mkdtemp(prefix="comprope"))


def _user_cache() -> Path:
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir())) / "comprope" / "cache"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "comprope"


def written(path: Path, text: str) -> str:
    """Write the text where it is not written yet, whole or not at all; returns the path."""
    if not path.exists():
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, suffix=".tmp") as file:
            file.write(text)
        Path(file.name).replace(path)
    return str(path)
