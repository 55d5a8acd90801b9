"""Reads and writes `run.json`: the options of a check and the paths of its logs and map.

Paths are relative to the result folder, so they stay valid if the folder is moved together with its logs.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field, fields, replace
from pathlib import Path, PurePath
from typing import Any, Final

import msgspec

from drivelint.drive.trace import DriveInput
from drivelint.errors import UsageError
from drivelint.result.names import RUN_FILE

_PATH_OPTIONS: Final = ("map", "map_dir")
_JSON_KEY_OF_FIELD: Final = {"relative_paths": "named", "manifest_options": "own"}
"""Field -> its key in the file, for fields with another key."""


@dataclass(frozen=True)
class RunRequest(DriveInput):
    """The options of a check that affect its verdicts, named as in `check`. `traces`: drive_id -> path of its log.

    `relative_paths`: drive_id -> path of its log from the folder in which the check ran, with `/`; logs outside that folder are omitted.
    `ego`: the option as given; the verdicts name the judged egos. `manifest_options`: drive_id -> the options from a manifest for that
    log, which replace the options of the run.
    """

    traces: dict[str, str] = field(default_factory=dict)
    relative_paths: dict[str, str] = field(default_factory=dict)
    profiles: tuple[str, ...] = ()
    params: tuple[str, ...] = ()
    rules_dirs: tuple[Path, ...] = ()
    robustness: bool | None = None
    manifest_options: dict[str, DriveInput] = field(default_factory=dict)

    def of_drive(self, drive_id: str) -> RunRequest:
        """Return the request with the options of one drive."""
        own_options = self.manifest_options.get(drive_id)
        return (
            self
            if own_options is None
            else replace(self, **{field.name: getattr(own_options, field.name) for field in fields(DriveInput)})
        )

    @classmethod
    def from_options(
        cls, options: DriveInput, traces: dict[str, str], manifest_options: dict[str, DriveInput] | None = None
    ) -> RunRequest:
        """Return the request with the options of `check`, unchanged except for the traces."""
        apart = {"traces", *_JSON_KEY_OF_FIELD}
        values = {field.name: getattr(options, field.name) for field in fields(cls) if field.name not in apart}
        relative_paths = {
            drive: path
            for drive, path in sorted((name, _path_relative_to_workdir(path)) for name, path in traces.items())
            if path
        }
        return cls(**values, traces=traces, relative_paths=relative_paths, manifest_options=manifest_options or {})


def render(run_options: RunRequest, out: Path) -> bytes:
    """Return the request as UTF-8 JSON with a final newline, every path relative to the result folder `out`."""
    content: dict[str, Any] = msgspec.to_builtins(run_options, enc_hook=str)
    options = {_JSON_KEY_OF_FIELD.get(name, name): value for name, value in content.items() if name != "traces"}
    plain = {
        "traces": {drive: _relative_path(path, out) for drive, path in sorted(content["traces"].items())},
        **options,
    }
    plain["rules_dirs"] = [_relative_path(path, out) for path in plain["rules_dirs"]]
    _make_paths_relative(plain, out)
    for own_options in plain["own"].values():
        _make_paths_relative(own_options, out)
    if not plain["own"]:
        del plain["own"]
    return (json.dumps(plain, indent=2, ensure_ascii=False) + "\n").encode()


def load(folder: Path) -> RunRequest:
    """Return the request stored in a result folder, with its paths joined to that folder.

    Errors: `UsageError` if `run.json` is missing or damaged.
    """
    file = folder / RUN_FILE
    try:
        plain = {"visibility": "none", "ego": None, "robustness": True} | json.loads(
            file.read_text(encoding="utf-8")
        )  # older results lack these keys
        for options in (plain, *plain.get("own", {}).values()):
            _join_paths_to_folder(folder, options)
        plain["traces"] = {drive: str(folder / path) for drive, path in plain["traces"].items()}
        plain["rules_dirs"] = [str(folder / path) for path in plain["rules_dirs"]]
        plain |= {field_: plain.pop(name) for field_, name in _JSON_KEY_OF_FIELD.items() if name in plain}
        return msgspec.convert(plain, RunRequest, dec_hook=lambda kind, value: kind(value))
    except FileNotFoundError as error:
        raise UsageError(
            f"{file} is missing: name the folder that check --out wrote, or check the drives again"
        ) from error
    except (OSError, ValueError, KeyError, TypeError, AttributeError, msgspec.ValidationError) as error:
        raise UsageError(f"{file}: not what drivelint writes: check the drives again") from error


def _make_paths_relative(plain: dict[str, Any], out: Path) -> None:
    """Make the paths of the options about a log relative to the result folder."""
    plain |= {key: _relative_path(plain[key], out) for key in _PATH_OPTIONS if plain[key] is not None}
    if plain["mapping"] is not None and Path(plain["mapping"]).is_file():  # else the name of a shipped mapping
        plain["mapping"] = {"file": _relative_path(plain["mapping"], out)}


def _join_paths_to_folder(folder: Path, plain: dict[str, Any]) -> None:
    """Undo `_make_paths_relative`."""
    if isinstance(plain["mapping"], dict):
        plain["mapping"] = str(folder / plain["mapping"]["file"])
    plain |= {key: str(folder / plain[key]) for key in _PATH_OPTIONS if plain[key] is not None}


def _path_relative_to_workdir(path: str) -> str:
    """Return a path relative to the working folder, if possible without resolving links; '' for a path outside that folder."""
    here = Path.cwd()
    as_given = PurePath(os.path.abspath(path))  # noqa: PTH100 - resolve() follows links
    for whole in (as_given, Path(path).resolve()):
        if whole.is_relative_to(here):
            return whole.relative_to(here).as_posix()
    return ""


def _relative_path(path: str, out: Path) -> str:
    whole = Path(path).resolve()
    try:
        return Path(os.path.relpath(whole, out.resolve())).as_posix()
    except ValueError:  # on another disk
        return whole.as_posix()
