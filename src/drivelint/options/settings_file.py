"""The options of `check` in settings files: their names, which of them are paths, and their JSON schema for editors."""

from __future__ import annotations

import json
from pathlib import Path
from types import NoneType
from typing import Any, Final, Literal, get_args, get_origin

from drivelint.options.arguments import CheckCommandArguments
from drivelint.options.declaration import DeclaredOption, declared_options
from drivelint.options.types import NAME_OR_PATH
from drivelint.settings import read_settings

_OPTIONS_NOT_IN_FILE: Final = frozenset({"today"})
"""Options that a settings file may not set: with a fixed `today`, waivers would never expire."""
_JSON_TYPES: Final = {bool: "boolean", float: "number", int: "integer"}
_WAIVERS_SCHEMA: Final = {
    "type": "array",
    "description": "Findings that an owner accepts until a day.",
    "items": {
        "type": "object",
        "additionalProperties": False,
        "required": ["rule", "reason", "owner", "expires"],
        "properties": {
            **{name: {"type": "string"} for name in ("rule", "drive", "ego", "object", "profile", "reason", "owner")},
            **{name: {"type": "number"} for name in ("from_s", "to_s")},
            "expires": {"type": "string", "format": "date"},
        },
    },
}


def settable_options() -> dict[str, DeclaredOption]:
    """Return key -> option of `check`, for the options that a settings file may set."""
    options = {
        declared.flags[0].partition("/")[0].lstrip("-"): declared
        for declared in declared_options(CheckCommandArguments)
    }
    return {
        key: declared
        for key, declared in options.items()
        if not declared.is_positional and key not in _OPTIONS_NOT_IN_FILE
    }


def settings_of_check(file: Path) -> dict[str, Any]:
    """Return the settings of a file as parameter of the command line -> value. Errors: `UsageError`."""
    options = settable_options()
    paths = {
        key
        for key, option in options.items()
        if option.type is NAME_OR_PATH or _value_type(option) in {Path, list[Path]}
    }
    return read_settings({key: (option.field, _is_repeatable(option)) for key, option in options.items()}, file, paths)


def settings_schema() -> str:
    """Return the JSON schema of `drivelint.toml`, with a final newline."""
    properties = {
        key: {**_value_schema(declared), "description": declared.option.help}
        for key, declared in settable_options().items()
    }
    texts = properties["env"]
    values = {"type": "object", "additionalProperties": {"type": ["string", "boolean"]}}
    properties["env"] = {"anyOf": [values, {k: v for k, v in texts.items() if k != "description"}]}
    properties["env"]["description"] = texts["description"]
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "drivelint.toml",
        "description": "Options of drivelint check for a project; pyproject.toml has the same under [tool.drivelint].",
        "type": "object",
        "additionalProperties": False,
        "properties": {**dict(sorted(properties.items())), "waiver": _WAIVERS_SCHEMA},
    }
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def _value_type(option: DeclaredOption) -> Any:
    """Return the type of a value, without None."""
    kind = option.type.command_line_type
    return get_args(kind)[0] if NoneType in get_args(kind) else kind


def _is_repeatable(option: DeclaredOption) -> bool:
    return get_origin(_value_type(option)) is list


def _value_schema(option: DeclaredOption) -> dict[str, Any]:
    if _is_repeatable(option):
        return {"type": "array", "items": {"type": "string"}}
    kind = _value_type(option)
    return {"enum": list(get_args(kind))} if get_origin(kind) is Literal else {"type": _JSON_TYPES.get(kind, "string")}
