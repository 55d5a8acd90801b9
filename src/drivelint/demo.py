"""Writes the files of `drivelint demo`: overtakes as in the paper of Harper et al., their road, and the command that checks them.

They are copies of files in `fixtures/scenes`, which `tests/demo` generates.
"""

from __future__ import annotations

import shlex
from pathlib import PurePath
from shutil import which
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.resources import folder
from drivelint.result.publishing import publish

if TYPE_CHECKING:
    from pathlib import Path

ROAD_FILE: Final = "road.xodr"
_FIXTURE_BY_FILE: Final = {ROAD_FILE: "overtake-road.xodr"} | {
    name: name for scene in ("safe", "near-miss", "collision") for name in (f"{scene}.mcap", f"{scene}-25mph.mcap")
}
_GENERATOR = b"drivelint demo"
_HEAD_BYTES = 1024  # the header contains the generator's name, in MCAP and in OpenDRIVE


def contents() -> dict[str, bytes]:
    """Return file name -> content of all files."""
    scenes = folder("fixtures") / "scenes"
    return {name: (scenes / source).read_bytes() for name, source in _FIXTURE_BY_FILE.items()}


def write(out: Path) -> list[Path]:
    """Write the files into the folder `out`, and replace the files of an earlier demo.

    Errors: `UsageError` if a file of the same name is not from a demo (nothing is written then); `OutputError` if the
    folder cannot be written.
    """
    files = contents()
    for name in files:
        _refuse_to_overwrite_others_file(out / name)
    publish(out, files, {})
    return [out / name for name in files]


def _refuse_to_overwrite_others_file(path: Path) -> None:
    if not path.exists() and not path.is_symlink():
        return
    try:
        with path.open("rb") as file:
            is_of_demo = _GENERATOR in file.read(_HEAD_BYTES)
    except OSError:
        is_of_demo = False
    if not is_of_demo:
        raise UsageError(f"{path} was not written by this demo, so it stays as it is: choose another folder")


def check_command(out: Path, executable: str = "drivelint") -> str:
    """Return the shell command that checks the written files. `executable`: the path with which drivelint was started."""
    there = shlex.quote(str(out))
    program = (
        shlex.quote(executable) if PurePath(executable).name == "drivelint" and not which("drivelint") else "drivelint"
    )
    return f"{program} check {there}/*.mcap --map {there}/{ROAD_FILE} --out {there}/results"
