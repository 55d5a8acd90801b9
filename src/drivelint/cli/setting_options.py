"""The options of `check` in settings files: their names, which of them are paths, and their JSON schema for editors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, get_args, get_origin

if TYPE_CHECKING:
    from collections.abc import Iterable

_OPTIONS_NOT_IN_FILE: Final = frozenset({"help", "today"})
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


def params_by_setting(params: Iterable[Any]) -> dict[str, Any]:
    """Return name without the leading dashes -> parameter of `check`, for the parameters that a settings file may set."""
    options = {p.opts[0].lstrip("-"): p for p in params if p.param_type_name == "option"}
    return {name: param for name, param in options.items() if name not in _OPTIONS_NOT_IN_FILE}


def names_of_path_settings(params: Iterable[Any]) -> set[str]:
    """Return the names of the settings whose values are or may be paths."""
    known = params_by_setting(params)
    return {name for name, param in known.items() if _type_annotation(param) in {Path, list[Path]}} | {"mapping"}


def settings_schema(params: Iterable[Any]) -> str:
    """Return the JSON schema of `drivelint.toml`, with a final newline. `params`: the parameters of `check`."""
    properties = {
        name: {**_value_schema(_type_annotation(param)), "description": param.help}
        for name, param in params_by_setting(params).items()
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


def _type_annotation(param: Any) -> Any:
    return param.type_descriptor.annotation


def _value_schema(annotation: Any) -> dict[str, Any]:
    if get_origin(annotation) is list:
        return {"type": "array", "items": {"type": "string"}}
    if get_origin(annotation) is Literal:
        return {"enum": list(get_args(annotation))}
    return {"type": _JSON_TYPES.get(annotation, "string")}
