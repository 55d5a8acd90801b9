"""A folder of canonical Parquet tables, or one Parquet file with the columns of `actor_state`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.formats.files import is_canonical_folder

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {
    "canonical-parquet": ("drivelint's own Parquet tables", "marked is_ego in the log")
}
takes_mapping: Final = False


def accepts(probe: Probe) -> bool:
    """Accept a folder, or Parquet with canonical columns unless a mapping was asked for."""
    from drivelint.formats.tables import canonical

    if probe.path.is_dir():
        return is_canonical_folder(probe.path)
    return probe.options.mapping is None and probe.head.startswith(b"PAR1") and canonical.has_columns(probe.path)


def read(probe: Probe) -> Recording:
    """Read the canonical tables."""
    from drivelint.formats.tables import canonical

    return canonical.read(probe.path)
