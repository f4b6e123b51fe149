"""The cache of compiled kernels and FMUs: damaged files are made anew, and no folder is used that another user may write to."""

import logging
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numba
import pytest

from comprope import user_cache
from comprope.kernels.disk_cache import compiled_files, source_file
from comprope.user_cache import KEPT, RECENT, entry_folder, verified_files, write_whole
from comprope_system.simulation.cosim import fmu_cache
from comprope_system.simulation.fmu_export.recipes import Recipe

posix = pytest.mark.skipif(sys.platform == "win32", reason="owner and mode are not checked on Windows")
root = pytest.mark.skipif(sys.platform == "win32" or os.getuid() != 0, reason="only root can give a folder to another user")
ANOTHER_USER = 12345
SOURCE = "def call_triple(x):\n    return 3.0 * x\n"


@pytest.fixture(autouse=True)
def folders(tmp_path, monkeypatch):
    """A cache, a user's cache folder and a folder of temporary files of the test's own, that nothing else uses."""
    for name in ("named", "user", "temporary"):
        (tmp_path / name).mkdir(mode=0o700)
    monkeypatch.setenv("COMPROPE_CACHE", str(tmp_path / "named"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "user"))
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path / "user"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    user_cache._remark.cache_clear()
    user_cache._temporary_folder.cache_clear()
    return tmp_path


# -- damaged files -------------------------------------------------------------------------------


def compile_triple(folder: Path) -> Any:
    """A kernel as the entry points compile it: from a source file, through numba's cache beside it."""
    names: dict[str, Any] = {}
    exec(compile(SOURCE, source_file(folder, SOURCE), "exec"), names)
    with compiled_files(folder, SOURCE, "call_triple"):
        return numba.cfunc("float64(float64)", cache=True)(names["call_triple"])


def index_and_code(folder: Path) -> list[Path]:
    files = sorted((folder / "__pycache__").glob("joined.call_triple-*"))
    assert [file.suffix for file in files] == [".nbc", ".nbi"]
    return files


DAMAGES = {
    "cut short": lambda file: file.write_bytes(file.read_bytes()[:-7]),
    "empty": lambda file: file.write_bytes(b""),
    "foreign": lambda file: file.write_bytes(b"no pickle of numba's"),
    "another pickle": lambda file: file.write_bytes(b"cbuiltins\nexit\n(I3\ntR."),  # ends the program when it is unpickled
    "a flipped bit": lambda file: file.write_bytes(file.read_bytes()[:-40] + b"!" + file.read_bytes()[-39:]),
    "a folder": lambda file: (file.unlink(), file.mkdir(), (file / "inside").touch()),
    "absent": lambda file: file.unlink(),
}


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_of_a_kernel_is_made_anew(damage, suffix):
    folder = entry_folder("kernels", "test")
    assert compile_triple(folder).cache_hits == 0
    assert compile_triple(folder).cache_hits == 1
    (file,) = (one for one in index_and_code(folder) if one.suffix == suffix)
    DAMAGES[damage](file)
    again = compile_triple(folder)
    assert again.cache_hits == 0 and again.ctypes(2.0) == 6.0
    assert compile_triple(folder).cache_hits == 1


def test_a_damaged_source_file_or_record_is_made_anew():
    folder = entry_folder("kernels", "test")
    compile_triple(folder)
    (folder / "joined.py").write_text(SOURCE[:-3])
    assert compile_triple(folder).ctypes(2.0) == 6.0 and (folder / "joined.py").read_text() == SOURCE
    (record,) = (folder / "__pycache__").glob("*.sha256")
    record.write_bytes(record.read_bytes()[:20])
    assert compile_triple(folder).cache_hits == 0
    assert compile_triple(folder).cache_hits == 1


def test_a_folder_removed_while_a_program_runs_is_made_anew():
    folder = entry_folder("kernels", "test")
    compile_triple(folder)
    shutil.rmtree(folder)
    assert compile_triple(folder).ctypes(2.0) == 6.0


def test_kernels_stay_in_the_cache_whatever_folder_numba_is_given(folders, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(folders / "elsewhere"))
    folder = entry_folder("kernels", "test")
    compile_triple(folder)
    assert index_and_code(folder) and not (folders / "elsewhere").exists()
    assert str(folders / "elsewhere") == numba.config.CACHE_DIR


@pytest.mark.parametrize("damage", ["cut short", "foreign", "a folder"])
def test_a_damaged_fmu_is_built_anew(damage, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Recipe, "build", lambda _recipe, out, reference: write_whole(out / "ElevatorDrive.fmu", "new"))
    fmu = fmu_cache.drive_fmu()
    assert fmu.is_relative_to(tmp_path / "named" / "fmu") and fmu.read_text() == "new"
    DAMAGES[damage](fmu)
    assert fmu_cache.drive_fmu() == fmu and fmu.read_text() == "new"
    monkeypatch.setattr(Recipe, "build", None)  # not called where the file is whole
    assert fmu_cache.drive_fmu().read_text() == "new"


# -- whose folder --------------------------------------------------------------------------------


def chosen(caplog) -> tuple[Path, str]:
    """The cache in use and the remark about folders refused."""
    with caplog.at_level(logging.WARNING, "comprope.user_cache"):
        folder = entry_folder("kernels", "test")
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700 or sys.platform == "win32"
    return folder.parents[1], "\n".join(caplog.messages)


def test_the_named_folder_comes_first_then_the_users_then_a_temporary_one(folders, monkeypatch, caplog):
    assert chosen(caplog) == (folders / "named", "")
    monkeypatch.delenv("COMPROPE_CACHE")
    assert chosen(caplog) == (folders / "user" / "comprope", "")
    (folders / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(folders / "file"))
    monkeypatch.setenv("LOCALAPPDATA", str(folders / "file"))
    root, remark = chosen(caplog)
    assert root.parent == folders / "temporary" and f"{folders / 'file' / 'comprope'}: Not a directory" in remark


UNSAFE = {
    "group may write": lambda folder: folder.chmod(0o770),
    "all may write": lambda folder: folder.chmod(0o777),
    "all may write above": lambda folder: (folder / "below").mkdir(mode=0o700) or folder.chmod(0o777),
    "sticky": lambda folder: folder.chmod(0o1777),
    "a link to where all may write": lambda folder: (
        folder.rmdir(), folder.with_name("open").mkdir(), folder.with_name("open").chmod(0o777), folder.symlink_to("open")
    ),
}  # fmt: skip


@posix
@pytest.mark.parametrize("case", UNSAFE)
def test_a_folder_that_others_may_write_to_is_refused_with_a_remark(case, folders, caplog, monkeypatch):
    UNSAFE[case](folders / "named")
    named = folders / "named" / ("below" if "above" in case else "")
    monkeypatch.setenv("COMPROPE_CACHE", str(named))
    root, remark = chosen(caplog)
    open_folder = folders / ("open" if "link" in case else "named")
    assert root == folders / "user" / "comprope" and not list(named.rglob("test"))
    assert remark == (
        f"The cache of compiled kernels and FMUs is in {root}, since others were refused: "
        f"{named}: other users may write to {open_folder}; `chmod go-w {open_folder}` changes that"
    )
    caplog.clear()
    assert chosen(caplog)[1] == ""  # not again at every kernel


@root
def test_a_folder_or_link_of_another_users_is_refused(folders, caplog, monkeypatch):
    os.chown(folders / "named", ANOTHER_USER, ANOTHER_USER)
    root, remark = chosen(caplog)
    assert root == folders / "user" / "comprope" and f"{folders / 'named'} belongs to another user (user 12345)" in remark
    (folders / "mine").mkdir(mode=0o700)
    (folders / "link").symlink_to(folders / "mine")
    monkeypatch.setenv("COMPROPE_CACHE", str(folders / "link"))
    assert chosen(caplog)[0] == folders / "link"  # a user's own link to a folder of theirs is theirs
    os.chown(folders / "link", ANOTHER_USER, ANOTHER_USER, follow_symlinks=False)
    root, remark = chosen(caplog)
    assert root == folders / "user" / "comprope" and f"{folders / 'link'} is a link of another user's" in remark


@root
def test_a_folder_below_another_users_is_refused(folders, caplog, monkeypatch):
    (folders / "named" / "below").mkdir(mode=0o700)
    os.chown(folders / "named", ANOTHER_USER, ANOTHER_USER)
    monkeypatch.setenv("COMPROPE_CACHE", str(folders / "named" / "below"))
    assert chosen(caplog)[0] == folders / "user" / "comprope"


@posix
def test_the_temporary_folder_with_this_users_name_is_checked_like_any_other(folders, caplog, monkeypatch):
    """Whoever makes it first, in a folder where all may, does not get programs run."""
    (folders / "named").chmod(0o777)
    (folders / "user").chmod(0o777)
    (folders / "temporary").chmod(0o1777)
    planted = folders / "temporary" / f"comprope-{os.getuid()}"
    planted.mkdir()
    planted.chmod(0o777)
    root, remark = chosen(caplog)
    assert root.parent == folders / "temporary" and root.name.startswith("comprope-") and root != planted
    assert not list(planted.iterdir()) and remark.count("other users may write to") == 3
    assert os.environ["COMPROPE_CACHE"] == str(root)  # for the processes that this one starts
    assert chosen(caplog)[0] == root


@posix
def test_entries_that_others_could_have_changed_are_discarded(folders):
    folder = entry_folder("kernels", "test")
    (folder / "joined.py").touch()
    folder.chmod(0o777)
    assert not list(entry_folder("kernels", "test").iterdir())
    (folders / "other").mkdir()
    folder.rmdir()
    folder.symlink_to(folders / "other")
    assert not entry_folder("kernels", "test").is_symlink() and (folders / "other").is_dir()


# -- several processes, and old entries ----------------------------------------------------------


MAKE_ONCE = """
import sys, time
from pathlib import Path
from comprope.user_cache import verified_files

folder, log = map(Path, sys.argv[1:])
with verified_files(folder, "made*"):
    if not (folder / "made.txt").is_file():
        time.sleep(0.5)
        (folder / "made.txt").write_text("made")
        with log.open("a") as file:
            file.write("made")
    print((folder / "made.txt").read_text(), end="")
"""


def test_processes_that_need_the_same_file_at_once_make_it_once(folders):
    folder, log = entry_folder("tests", "test"), folders / "log"
    command = [sys.executable, "-c", MAKE_ONCE, str(folder), str(log)]
    started = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [one.communicate(timeout=60)[0] for one in started] == ["made"] * 3 and log.read_text() == "made"


def test_what_fails_within_the_block_is_not_taken_for_whole():
    folder = entry_folder("tests", "test")
    with pytest.raises(KeyboardInterrupt), verified_files(folder, "*.fmu"):
        (folder / "part.fmu").write_text("a part")
        raise KeyboardInterrupt
    with verified_files(folder, "*.fmu"):
        assert not (folder / "part.fmu").exists()


def test_entries_used_longest_ago_are_removed_when_a_new_one_is_made():
    old = time.time() - 2 * RECENT
    for k in range(KEPT + 3):
        os.utime(entry_folder("kernels", f"old{k}"), (old + k, old + k))
    entry_folder("kernels", "old0")  # used again
    for name in ("new", "newer"):
        kinds = entry_folder("kernels", name).parent
    left = {one.name for one in kinds.iterdir()}
    assert left == {"new", "newer", "old0"} | {f"old{k}" for k in range(6, KEPT + 3)} and len(left) == KEPT
    for k in range(KEPT):
        entry_folder("kernels", f"recent{k}")
    entry_folder("kernels", "one more")
    assert {f"recent{k}" for k in range(KEPT)} <= {one.name for one in kinds.iterdir()}
