"""The message definitions that are used for a bag without its own: only recorders since Iron write definitions into SQLite files."""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib.resources import files
from typing import Final

_TYPE: Final = re.compile(r"^([a-z]\w*/\w+)", re.MULTILINE)
_RULE: Final = "=" * 80


def candidates(kind: str) -> list[str]:
    """Return the definitions that a message type may have, each with all messages that it contains; [] for a type that is not known."""
    messages, variants = _known()
    if kind not in messages:
        return []
    newest = messages | variants
    return list(dict.fromkeys(_definition(kind, each) for each in (messages, newest)))


@cache
def _known() -> tuple[dict[str, str], dict[str, str]]:
    tables = tomllib.loads(files(__package__).joinpath("definitions.toml").read_text(encoding="utf-8"))
    return tables["messages"], tables["variants"]


def _definition(kind: str, messages: dict[str, str]) -> str:
    used = [kind]
    for each in used:  # grows while it is read
        used += [inner for inner in dict.fromkeys(_TYPE.findall(messages[each])) if inner not in used]
    return "\n".join([messages[kind], *(f"{_RULE}\nMSG: {each}\n{messages[each]}" for each in used[1:])])
