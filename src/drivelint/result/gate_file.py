"""Reads and writes `gate.json`, which is there only if a baseline or waivers were given."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.errors import UsageError
from drivelint.result.gate import Gate  # noqa: TC001 - msgspec reads it

if TYPE_CHECKING:
    from pathlib import Path

FILE: Final = "gate.json"
GATE_VERSION: Final = 1
"""Version of the file: raised when a key changes its meaning or goes."""


@dataclass(frozen=True)
class _File:
    gate_schema: int
    gate: Gate


def render(gate: Gate) -> bytes:
    """Return a gate as UTF-8 JSON with a final newline; numbers that are not finite are null."""
    return msgspec.json.format(msgspec.json.encode(_File(GATE_VERSION, gate)), indent=2) + b"\n"


def load(folder: Path) -> Gate | None:
    """Return what a result folder says of its gate; None: there was none. Errors: `UsageError` for a file of another kind."""
    path = folder / FILE
    try:
        found = msgspec.json.decode(path.read_bytes(), type=_File)
    except FileNotFoundError:
        return None
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: cannot be read as the gate of a result ({error}): check the drives again") from error
    if found.gate_schema != GATE_VERSION:
        raise UsageError(
            f"{path}: written with gate schema {found.gate_schema}, this drivelint reads {GATE_VERSION}: check the drives again"
        )
    return found.gate
