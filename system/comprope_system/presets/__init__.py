"""Model files included with the program: the paper's 50 m test tower, with nominal and light sheave, and 200 m building."""

from pathlib import Path

from comprope.errors import InputError
from comprope.validation_messages import suggestion

_FOLDER = Path(__file__).parent


def names() -> list[str]:
    """The presets' names, accepted wherever a command takes a model file."""
    return sorted(path.stem for path in _FOLDER.glob("*.toml") if "." not in path.stem)


def model_path(name_or_path: str | Path) -> Path:
    """Path of a model file from a path or the name of a preset.

    Raises `InputError` if it is neither, with the nearest preset's name.
    """
    text = str(name_or_path)
    if text in names() and not Path(text).is_file():
        return _FOLDER / f"{text}.toml"
    if Path(text).exists() or Path(text).suffix or len(Path(text).parts) > 1:
        return Path(text)
    raise InputError(f"{text}: neither a file nor a preset; {suggestion(text, names())}")


def drive_path(name: str) -> Path | None:
    """The parameter file of the drive that belongs to a preset; None for anything else."""
    path = _FOLDER / f"{name}.drive.toml"
    return path if name in names() else None
