"""Seconds from a cold process to the first time step: the first time on a machine, which compiles, and later.

python benchmarks/start.py
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FIRST_STEP = "from cases import model, ride, trip; ride(model('tower50'), trip('tower50', 2.0, 47.0), 0.02)"


def seconds(cache: str) -> float:
    """Wall time of a process that settles the tower's rope and makes one communication step of 20 ms."""
    begin = time.perf_counter()
    environment = os.environ | {"COMPROPE_CACHE": cache}
    subprocess.run([sys.executable, "-c", FIRST_STEP], check=True, cwd=Path(__file__).parent, env=environment)
    return time.perf_counter() - begin


def main() -> None:
    """Print both times."""
    with tempfile.TemporaryDirectory() as cache:
        print(f"first time, empty cache  {seconds(cache):6.1f} s")
        print(f"later                    {min(seconds(cache) for _ in range(3)):6.2f} s")


if __name__ == "__main__":
    main()
