"""The message definitions that are used for a bag without its own: only recorders since Iron write definitions into SQLite files."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.formats.ros2.types import NUMPY_CODES, TEXT_TYPES, short_type_name
from drivelint.receipts.events import report_searched_path

if TYPE_CHECKING:
    from pathlib import Path

_MESSAGE_TYPE_PATTERN: Final = re.compile(r"^([a-z]\w*/\w+)", re.MULTILINE)
_MEMBER_PATTERN: Final = re.compile(r"^\s*([A-Za-z][\w/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w+", re.MULTILINE)
_MOST_FILE_BYTES: Final = 1 << 20
_MOST_MESSAGE_TYPES_IN_DEFINITION: Final = 200
_DEFINITION_SEPARATOR: Final = "=" * 80


def candidate_definitions(kind: str) -> list[str]:
    """Return the definitions that a message type may have, the newest first, each with all messages that it contains.

    [] for a type that is not known.
    """
    messages, variants = _definitions_and_newer_variants()
    if kind not in messages:
        return []
    newest = messages | variants
    return list(dict.fromkeys(_definition_with_members(kind, variant) for variant in (newest, messages)))


def definition_in_files(folder: Path, kind: str) -> str:
    """Return the definition of a message type by the files `PACKAGE/msg/NAME.msg` in a folder, with all messages that it contains.

    Messages that drivelint knows need no file. Errors: `UsageError` for a file that is missing or cannot be read.
    """
    messages = {kind: _definition_file_text(folder, kind)}
    waiting = [kind]
    while waiting:
        container = waiting.pop()
        for word in dict.fromkeys(_MEMBER_PATTERN.findall(messages[container])):
            inner = _full_type_name(word, container)
            if inner is None or inner in messages:
                continue
            definition = _definitions_and_newer_variants()[0].get(inner)
            messages[inner] = definition if definition is not None else _definition_file_text(folder, inner)
            waiting.append(inner)
            if len(messages) > _MOST_MESSAGE_TYPES_IN_DEFINITION:
                raise UsageError(f"{folder}: {kind} contains more than {_MOST_MESSAGE_TYPES_IN_DEFINITION} messages")
    members = (f"{_DEFINITION_SEPARATOR}\nMSG: {member}\n{text}" for member, text in messages.items() if member != kind)
    return "\n".join([messages[kind], *members])


def _full_type_name(word: str, container: str) -> str | None:
    """Return the full name of a member's type; None for a primitive."""
    if word in NUMPY_CODES or word in TEXT_TYPES:
        return None
    name = short_type_name(word)
    if name == "Header":
        return "std_msgs/Header"
    return name if "/" in name else f"{container.split('/', maxsplit=1)[0]}/{name}"


def _definition_file_text(folder: Path, kind: str) -> str:
    package, name = kind.split("/", maxsplit=1)
    path = folder / package / "msg" / f"{name}.msg"
    try:
        with report_searched_path(path).open(encoding="utf-8") as file:
            return file.read(_MOST_FILE_BYTES)
    except (OSError, UnicodeDecodeError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise UsageError(
            f"{path}: the definition of {kind} cannot be read: {why}: copy the folder msg of the package {package} into {folder / package}"
        ) from error


@cache
def _definitions_and_newer_variants() -> tuple[dict[str, str], dict[str, str]]:
    tables = tomllib.loads(files(__package__).joinpath("definitions.toml").read_text(encoding="utf-8"))
    return tables["messages"], tables["variants"]


def _definition_with_members(kind: str, messages: dict[str, str]) -> str:
    used = [kind]
    for member in used:  # grows while it is read
        used += [inner for inner in dict.fromkeys(_MESSAGE_TYPE_PATTERN.findall(messages[member])) if inner not in used]
    return "\n".join(
        [messages[kind], *(f"{_DEFINITION_SEPARATOR}\nMSG: {member}\n{messages[member]}" for member in used[1:])]
    )
