"""Builds the command that judges one drive of an audit again and writes a report."""

from __future__ import annotations

import json
import shlex
from dataclasses import fields
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit.bucket import is_url
from drivelint.drive.trace import DriveInput

if TYPE_CHECKING:
    from collections.abc import Mapping

_OPTION_OF_FIELD: Final = {"sensor_range_m": "--sensor-range"}
_DEFAULT_BY_FIELD: Final = {field.name: field.default for field in fields(DriveInput)}
_OPTION_OF_SETTING: Final = {
    "rules": "--rules",
    "ignore": "--ignore",
    "profiles": "--profile",
    "params": "--param",
    "rules_dirs": "--rules-dir",
}


def check_command(log: str, options: str | None, settings: Mapping[str, Any], drive_id: str) -> list[str]:
    """Return the words of the command `drivelint check` for a drive. An option and its value are one item of the list.

    `options`: the drive's options (`DriveInput`) as JSON. `settings`: the audit's settings. `check` only reads local files: for a log in an
    object store, the command has the file name of a local copy.
    """
    parts = [["drivelint", "check"], [_name_of_local_copy(log)]]
    for name, value in json.loads(options or "{}").items():
        parts += _option_words(name, value)
    for name, option in _OPTION_OF_SETTING.items():
        parts += [[option, str(value)] for value in settings.get(name, ())]
    parts.append(["--out", f"drives/{drive_id}"])
    return [shlex.join(words) for words in parts]


def _option_words(name: str, value: Any) -> list[list[str]]:
    if name not in _DEFAULT_BY_FIELD or value in (None, _DEFAULT_BY_FIELD[name], []):
        return []
    option = _OPTION_OF_FIELD.get(name, f"--{name.replace('_', '-')}")
    if name == "env":
        return [[option, setting] for setting in value]
    if isinstance(value, list):  # with '=', because a negative number looks like an option
        return [[f"{option}={','.join(f'{number:.12g}' for number in value)}"]]
    return [[option, _name_of_local_copy(str(value)) if name in {"map", "map_dir", "mapping"} else str(value)]]


def _name_of_local_copy(name: str) -> str:
    return name.rpartition("/")[2] if is_url(name) else name
