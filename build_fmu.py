"""Build the FMUs: `python build_fmu.py` writes dist/CompensationRope.fmu and dist/ElevatorDrive.fmu.

With `--native` it writes dist/CompensationRope_native.fmu and dist/ElevatorDrive_native.fmu as well, which need no Python, and
with `--fmi3` the same for FMI 3.0, named ..._native_fmi3.fmu; with `--ssp` dist/Elevator.ssp, drive and rope connected, the
native ones of FMI 2.0 if there are any. `comprope fmu` does the same from an installed package.
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent
sys.path[:0] = [str(ROOT / "fmu_src"), str(ROOT / "system")]

import comprope_system  # noqa: E402
from comprope import consent  # noqa: E402
from comprope.errors import CompropeError, InputError  # noqa: E402


def main(arguments: list[str] | None = None) -> int:
    """Build the FMUs and print their paths; returns the exit status: 0 done, 2 bad input, 1 anything else."""
    options = _options(arguments)
    wanted = {name: getattr(options, name) for name in ("sensors", "native", "fmi3", "ssp")}
    try:
        with consent.giving(options.allow_code):
            paths = comprope_system.fmu(options.model, **wanted).save(options.out)
    except CompropeError as error:
        sys.stderr.write(f"{error}\n")
        return 2 if isinstance(error, InputError) else 1
    sys.stdout.writelines(f"{path}\n" for path in paths)
    return 0


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--model", default="tower50", metavar="MODEL.toml", help="rope model to start from, or a preset")
    parser.add_argument("--sensors", type=int, metavar="N", help="number of displacement sensors; default: those of the model")
    parser.add_argument("--out", type=Path, default=ROOT / "dist", metavar="DIR", help="folder to write to (default: dist)")
    parser.add_argument("--ssp", action="store_true", help="drive and rope also as one system, connected")
    parser.add_argument("--native", action="store_true", help="rope and drive also as FMUs that need no Python")
    parser.add_argument("--fmi3", action="store_true", help="rope and drive also as FMUs for FMI 3.0 that need no Python")
    parser.add_argument("--allow-code", action="store_true", help="run the files of own effects that the model names")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
