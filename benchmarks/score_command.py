"""The command on a campaign's copy, as a user would run it."""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

Json = dict[str, Any]


def command(campaign: Path, name: str, words: Sequence[str], jobs: int, limit: float) -> tuple[int, Json, str]:
    """Exit status (-1: not done after `limit` seconds), JSON and error text of `comprope NAME CAMPAIGN WORDS...`."""
    out = campaign.parent / f"{name}.json"
    whole = [sys.executable, "-m", "comprope_system.cli", name, str(campaign), *words, "--json", str(out), "--jobs", str(jobs)]
    try:
        ended = subprocess.run(whole, capture_output=True, text=True, timeout=limit, check=False)
    except subprocess.TimeoutExpired:
        return -1, {}, f"not done after {limit:.0f} s"
    said = json.loads(out.read_text(encoding="utf-8")) if out.exists() else {}
    return ended.returncode, said, ended.stderr.strip().replace(str(campaign), "CAMPAIGN")[-2000:]
