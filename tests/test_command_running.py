"""The command in a shell: version, completion, encodings, closed and full outputs, interruption."""

import os
import signal
import subprocess
import sys
import time
from importlib import metadata
from pathlib import Path

import pytest

COMMAND = [sys.executable, "-c", "from comprope_system.cli import main; main()"]
PRINTING = ["modes", "tower50", "--set", "rope.element_length=0.2", "--count", "3"]
linux = pytest.mark.skipif(sys.platform != "linux", reason="looks at processes and devices of Linux")

SLEEPERS = """\
import sys, time
from pathlib import Path
from comprope_system.parallel.executors import workers
from comprope_system.parallel.sweep import sweep

def sleeping(case):
    Path(case["folder"], f"started{case['number']}").touch()
    time.sleep(60.0)

if __name__ == "__main__":
    with workers(2) as pool:
        sweep(sleeping, [{"folder": sys.argv[1], "number": k} for k in range(4)], pool)
"""


def run(*arguments: str, **settings: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | settings
    return subprocess.run([*COMMAND, *arguments], capture_output=True, text=True, env=environment, timeout=120, check=False)


def test_the_version_is_that_of_the_package() -> None:
    done = run("--version")
    assert (done.returncode, done.stdout, done.stderr) == (0, f"comprope {metadata.version('comprope')}\n", "")


@pytest.mark.parametrize(
    ("line", "wanted"), [("comprope sim", "simulate"), ("comprope simulate --du", ""), ("comprope fm", "fmu")]
)
def test_the_shell_completes_commands(line: str, wanted: str) -> None:
    words = {"COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}
    done = run(_COMPROPE_COMPLETE="complete_bash", **words)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.split() == wanted.split()


@pytest.mark.parametrize(
    ("arguments", "encoding"),
    [
        *((one, "ascii") for one in (["--help"], ["simulate", "--help"], ["simulate", "absent_лифт.toml"])),
        *((PRINTING, encoding) for encoding in ("ascii", "cp1252")),
    ],
)
def test_any_encoding_prints_everything(arguments: list[str], encoding: str) -> None:
    done = subprocess.run(
        [*COMMAND, *arguments], capture_output=True, env=os.environ | {"PYTHONIOENCODING": encoding}, timeout=120, check=False
    )
    assert done.returncode == (2 if "absent_лифт.toml" in arguments else 0)
    assert b"Error" not in done.stderr and (done.stdout or done.stderr)


@linux
@pytest.mark.parametrize("target", ["/dev/full", "pipe", "closed"])
@pytest.mark.parametrize("arguments", [PRINTING, ["--help"]])
def test_an_output_that_cannot_be_written_is_one_sentence(arguments: list[str], target: str) -> None:
    where = {"/dev/full": ">/dev/full", "pipe": "| true", "closed": ">&-"}[target]
    quoted = " ".join(f"'{one}'" for one in [*COMMAND, *arguments])
    script = f"set -o pipefail; {quoted} {where}; echo status $? >&2"
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, timeout=120, check=False)
    *lines, status = done.stderr.splitlines()
    assert status == "status 1" and done.stdout == ""
    if target != "pipe":  # a reader that has seen enough, such as head, needs no explanation
        assert len(lines) == 1 and lines[0].startswith("standard output: cannot be written: ")
    assert len(lines) <= 1


def descendants(process: int) -> list[int]:
    """Processes started by a process, and by those, that still run."""
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if fields[0] != "Z":
            parents[int(stat.parent.name)] = int(fields[1])
    found = [process]
    for one in found:
        found += [child for child, parent in parents.items() if parent == one]
    return found[1:]


@linux
@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_worker_outlives_the_command(tmp_path: Path, kind: signal.Signals) -> None:
    """Interrupted, ended or killed while its workers have a minute of work left."""
    script = tmp_path / "sleepers.py"
    script.write_text(SLEEPERS)
    with subprocess.Popen([sys.executable, str(script), str(tmp_path)], stderr=subprocess.PIPE) as parent:
        until = time.monotonic() + 60.0
        while len(list(tmp_path.glob("started*"))) < 2:
            assert time.monotonic() < until and parent.poll() is None
            time.sleep(0.05)
        children = descendants(parent.pid)
        assert len(children) >= 2
        parent.send_signal(kind)
        parent.communicate(timeout=120)
    until = time.monotonic() + 10.0
    while any(Path(f"/proc/{child}").exists() for child in children):
        assert time.monotonic() < until, "a worker is left"
        time.sleep(0.05)
