"""Reads `drivelint.toml`, which holds options of `check`.

    map = "road.xodr"
    profile = ["nominal", "aggressive"]
    fail-on = "major"

    [env]
    nation = "gb"
    weather = "dry"

Waivers may stand there as well, as tables [[waiver]]: see `drivelint.gate.waivers`.

A key is an option's name without its dashes; the command line overrides it. The file is looked for in the current
folder only, and relative paths in it start there too.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from drivelint.errors import UsageError
from drivelint.phrases import hint

if TYPE_CHECKING:
    from collections.abc import Mapping

SETTINGS_FILE: Final = "drivelint.toml"


def read_settings(options: Mapping[str, tuple[str, bool]], file: Path = Path(SETTINGS_FILE)) -> dict[str, Any]:
    """Return parameter name -> value from the settings file; nothing if there is none.

    `options`: option name without dashes -> (parameter name, whether it may be given more than once).
    Errors: `UsageError` with the file for bad TOML, an unknown key (with the nearest), or a value that no option takes.
    """
    import tomllib

    try:
        content = tomllib.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {}
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UsageError(f"{file}: not TOML: {error}") from error
    values: dict[str, Any] = {}
    for key, said in content.items():
        if key == "waiver":
            continue  # read where the gate is
        if key not in options:
            raise UsageError(f"{file}: unknown setting {key!r}; {hint(key, sorted(options))}")
        name, repeatable = options[key]
        value = _assignments(said, file) if key == "env" and isinstance(said, dict) else said
        texts = isinstance(value, list) and all(isinstance(item, str) for item in value)
        if not (texts if repeatable else isinstance(value, str | bool | int | float)):
            raise UsageError(f"{file}: {key} = {value!r}: must be {'a list of texts' if repeatable else 'one value'}")
        values[name] = value if repeatable or isinstance(value, bool) else str(value)
    return values


def _assignments(table: Mapping[str, Any], file: Path) -> list[str]:
    """Return the table [env] as `KEY=VALUE`, as the command line takes them."""
    words = {True: "yes", False: "no"}
    for key, value in table.items():
        if not isinstance(value, str | bool):
            raise UsageError(f"{file}: [env] {key} = {value!r}: must be a text")
    return [f"{key}={words[value] if isinstance(value, bool) else value}" for key, value in table.items()]
