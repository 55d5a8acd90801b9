"""What `convert` says about what it wrote."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from drivelint.convert import ConvertedTrace


def summary_text(written: ConvertedTrace) -> str:
    """Return what was written, and the command that checks it."""
    size = sum(written.files.values())
    amount = f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{max(size / 1e3, 0.1):.1f} kB"
    files = f"{len(written.files)} files, " if len(written.files) > 1 else ""
    road = f", the map {written.map_name} with it" if written.map_name else ", no map"
    ego = "" if written.has_ego else " --ego ID"
    command = (
        f"drivelint check {shlex.quote(str(written.path))}{ego}{'' if written.map_name else ' --map MAP'} --out results"
    )
    return (
        f"{written.path}: {files}{amount}, {written.n_states} states of {written.n_actors} actors{road}\n"
        f"check it, without a mapping, with: {command}"
    )
