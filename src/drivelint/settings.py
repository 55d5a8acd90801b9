"""Reads `drivelint.toml`, which contains options of `check`.

    map = "road.xodr"
    profile = ["nominal", "aggressive"]
    fail-on = "major"

    [env]
    nation = "gb"
    weather = "dry"

It may also contain waivers, as tables [[waiver]]: see `drivelint.gate.waivers`.

A key is an option's name without its dashes; the command line overrides it. `pyproject.toml` may have the same in a table
[tool.drivelint]. The nearest of these files is used, searched from the current folder upwards. Its relative paths start in its folder.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

SETTINGS_FILE: Final = "drivelint.toml"
PROJECT_FILE: Final = "pyproject.toml"
_TOOL_NAME: Final = "drivelint"


def find_settings() -> Path | None:
    """Return the settings file for the current folder; None: there is none. Errors: `UsageError` for bad TOML."""
    here = Path.cwd()
    for folder in (here, *here.parents):
        place = Path() if folder == here else folder
        for file in (place / SETTINGS_FILE, place / PROJECT_FILE):
            # pyproject.toml may have settings of other tools only
            if file.is_file() and (file.name == SETTINGS_FILE or (_mentions_drivelint(file) and settings_table(file))):
                return file
    return None


def _mentions_drivelint(file: Path) -> bool:
    try:
        return _TOOL_NAME.encode() in file.read_bytes()
    except OSError:
        return False


def settings_table(file: Path) -> dict[str, Any]:
    """Return the content of a settings file, for `pyproject.toml` the table [tool.drivelint]; empty if the file or table is missing.

    Errors: `UsageError` for bad TOML.
    """
    import tomllib

    try:
        content = parse_toml(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise UsageError(f"{file}: cannot be read: {error.strerror or error}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UsageError(f"{file}: not TOML: {error}") from error
    if file.name == PROJECT_FILE:
        tools = content.get("tool")
        content = tools.get(_TOOL_NAME, {}) if isinstance(tools, dict) else {}
    return content if isinstance(content, dict) else {}


def read_settings(
    known_options: Mapping[str, tuple[str, bool]], file: Path = Path(SETTINGS_FILE), path_options: Collection[str] = ()
) -> dict[str, Any]:
    """Return parameter name -> value from the settings file; empty if there is no file.

    `known_options`: option name without dashes -> (parameter name, whether it may be given more than once). `path_options`: options whose
    values are paths; a value of `mapping` is a path only if this file exists. Relative paths start in the folder of the settings file.
    Errors: `UsageError`, which names the file, for bad TOML, an unknown key (with the most similar one), or a value of a wrong type.
    """
    values: dict[str, Any] = {}
    for key, value_of_file in settings_table(file).items():
        if key == "waiver":
            continue  # read by `drivelint.gate.waivers`
        if key not in known_options:
            raise UsageError(f"{file}: unknown setting {key!r}; {hint(key, sorted(known_options))}")
        name, repeatable = known_options[key]
        value = (
            _environment_assignments(value_of_file, file)
            if key == "env" and isinstance(value_of_file, dict)
            else value_of_file
        )
        texts = isinstance(value, list) and all(isinstance(item, str) for item in value)
        if not (texts if repeatable else isinstance(value, str | bool | int | float)):
            raise UsageError(f"{file}: {key} = {value!r}: must be {'a list of texts' if repeatable else 'one value'}")
        value = value if repeatable or isinstance(value, bool) else str(value)
        values[name] = _resolve_paths(file.parent, value, is_path=key != "mapping") if key in path_options else value
    return values


def _resolve_paths(folder: Path, value: Any, *, is_path: bool) -> Any:
    """Return a path, or each path of a list, relative to `folder`; without `is_path`, only if such a file is there."""
    if isinstance(value, list):
        return [_resolve_paths(folder, item, is_path=is_path) for item in value]
    if folder == Path() or not isinstance(value, str) or not (is_path or (folder / value).is_file()):
        return value
    return str(folder / value)


def _environment_assignments(table: Mapping[str, Any], file: Path) -> list[str]:
    """Return the table [env] as texts `KEY=VALUE`, as on the command line."""
    words = {True: "yes", False: "no"}
    for key, value in table.items():
        if not isinstance(value, str | bool):
            raise UsageError(f"{file}: [env] {key} = {value!r}: must be a text")
    return [f"{key}={words[value] if isinstance(value, bool) else value}" for key, value in table.items()]
