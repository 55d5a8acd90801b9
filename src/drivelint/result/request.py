"""`run.json`: what a check was asked to do, and where its logs and map lay, so that one verdict can be judged anew later.

Paths are relative to the result folder: a folder that is moved together with its logs still finds them.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import msgspec

from drivelint.errors import UsageError

FILE: Final = "run.json"
_PATHS: Final = ("map", "map_dir")


@dataclass(frozen=True)
class Asked:
    """The options of a check that bear on its verdicts, by their names there; `traces`: drive_id -> where its log lay."""

    traces: dict[str, str] = field(default_factory=dict)
    map: str | None = None
    map_dir: str | None = None
    map_offset: tuple[float, float] | None = None
    map_origin: tuple[float, float] | None = None
    handedness: str = "auto"
    mapping: str | None = None
    topic: str | None = None
    sensor_range_m: float | None = None
    visibility: str = "none"
    """What results of an older version were judged by."""
    ego_size: tuple[float, float, float] | None = None
    env: tuple[str, ...] = ()
    profiles: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rules_dirs: tuple[str, ...] = ()


def render(asked: Asked, out: Path) -> bytes:
    """Return it as UTF-8 JSON with a final newline, every path relative to the result folder `out`."""
    plain: dict[str, Any] = msgspec.to_builtins(asked)
    plain["traces"] = {drive: _relative(path, out) for drive, path in sorted(asked.traces.items())}
    plain |= {key: _relative(plain[key], out) for key in _PATHS if plain[key] is not None}
    plain["rules_dirs"] = [_relative(path, out) for path in asked.rules_dirs]
    if asked.mapping is not None and Path(asked.mapping).is_file():  # else the name of a shipped one
        plain["mapping"] = {"file": _relative(asked.mapping, out)}
    return (json.dumps(plain, indent=2, ensure_ascii=False) + "\n").encode()


def load(folder: Path) -> Asked:
    """Return what the check asked that wrote the result folder, its paths as they are found from here.

    Errors: `UsageError` where the folder does not say it.
    """
    file = folder / FILE
    try:
        plain = json.loads(file.read_text(encoding="utf-8"))
        if isinstance(plain["mapping"], dict):
            plain["mapping"] = str(folder / plain["mapping"]["file"])
        plain["traces"] = {drive: str(folder / path) for drive, path in plain["traces"].items()}
        plain |= {key: str(folder / plain[key]) for key in _PATHS if plain[key] is not None}
        plain["rules_dirs"] = [str(folder / path) for path in plain["rules_dirs"]]
        return msgspec.convert(plain, Asked)
    except FileNotFoundError as error:
        raise UsageError(
            f"{file} is missing: name the folder that check --out wrote, or check the drives again"
        ) from error
    except (OSError, ValueError, KeyError, TypeError, AttributeError, msgspec.ValidationError) as error:
        raise UsageError(f"{file}: not what drivelint writes: check the drives again") from error


def _relative(path: str, out: Path) -> str:
    whole = Path(path).resolve()
    try:
        return Path(os.path.relpath(whole, out.resolve())).as_posix()
    except ValueError:  # on another disk
        return whole.as_posix()
