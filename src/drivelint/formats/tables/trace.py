"""Any CSV or Parquet table through a mapping."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {}
takes_mapping: Final = True


def accepts(probe: Probe) -> bool:
    """Accept Parquet, and whatever reads as text without markup."""
    head = probe.head
    return head.startswith(b"PAR1") or not (b"\0" in head or head.lstrip()[:1] in {b"<", b"{"})


def read(probe: Probe) -> Recording:
    """Read the table through the mapping named, or the only shipped one that fits."""
    from drivelint.formats.tables import mapped_table

    return mapped_table.read(probe.path, probe.options.mapping)
