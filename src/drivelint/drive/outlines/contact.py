"""Contacts of egos with things beside or on the road of which a log states an outline only: pylons, walls, buildings, trees.

An outline may be larger than the thing (the crown of a tree, the arm of a lamp, the box around a bent wall), so where an ego touches it, a
contact is not known. Such things are no actors: no other rule is about them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import shapely

from drivelint.arrays import rotate_vectors
from drivelint.drive.outlines.shapes import BOX_CORNERS
from drivelint.drive.trace import QualityFinding
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from drivelint.arrays import Floats, Indices, Mask
    from drivelint.drive.actors import Actors
    from drivelint.drive.order import Steps
    from drivelint.drive.outlines.shapes import Outline
    from drivelint.drive.trace import States

OUTLINE_CONTACT_CHECK: Final = "outline_contact"
"""The id of the check for an ego that touches an outline. Rules on contacts are unknown then, with the finding as reason."""


def outline_contact_findings(
    states: States, step: Steps, actors: Actors, egos: Iterable[str], outlines: Sequence[Outline]
) -> list[QualityFinding]:
    """Return a finding for each ego whose box touches an outline, at a step or between two. The states are sorted by actor and time."""
    findings: list[QualityFinding] = []
    if not outlines:
        return findings
    tree = shapely.STRtree([outline.shape for outline in outlines])
    for ego_id in egos:
        number, size = states.ids.index(ego_id), actors.ids.index(ego_id)
        length, width, height = (float(actors.sizes[name][size]) for name in ("length_m", "width_m", "height_m"))
        rows = np.flatnonzero((states.actor == number) & np.isfinite(states.place).all(axis=0))
        if not len(rows) or not np.isfinite(length + width):
            continue
        shapes, at = _swept_boxes(states, step, rows, length, width)
        place, outline = tree.query(shapes, predicate="intersects")
        z, high = (np.array([getattr(outlines[k], name) for k in outline]) for name in ("z_m", "height_m"))
        touches = ~_is_over_or_under(states.numbers["z_m"][at[place]], height, z, high)
        if touches.any():
            names = name_list(sorted({outlines[k].name for k in outline[touches]}))
            times = np.unique(states.t_ns[at[place[touches]]])
            message = (
                f"the box of {ego_id} touches the outline of {names}: an outline may be larger than the thing, "
                "so a contact is not known"
            )
            finding = QualityFinding(OUTLINE_CONTACT_CHECK, "warning", message, len(times), int(times[0]), ego_id)
            findings.append(finding)
    return findings


def _swept_boxes(states: States, step: Steps, rows: Indices, length: float, width: float) -> tuple[Floats, Indices]:
    """Return the areas that the box covers from each row to the next, (n,), and their rows; a row without a next one has its box alone."""
    x, y = states.place[:, rows]
    yaw = states.numbers["yaw_rad"][rows]
    has_heading = np.isfinite(yaw)
    # in any direction, the box is within this square along the axes
    side = np.hypot(length, width)
    long, wide = np.where(has_heading, length, side), np.where(has_heading, width, side)
    along, across = rotate_vectors(
        BOX_CORNERS[0] * long[:, None], BOX_CORNERS[1] * wide[:, None], np.where(has_heading, yaw, 0.0)[:, None]
    )
    corners = np.stack([x[:, None] + along, y[:, None] + across], axis=2)
    goes_on = np.zeros(len(rows), np.bool_)
    goes_on[:-1] = (np.diff(rows) == 1) & step.continuous[rows[:-1]]
    later = np.where(goes_on[:, None, None], np.roll(corners, -1, axis=0), corners)
    return shapely.convex_hull(shapely.multipoints(np.concatenate([corners, later], axis=1))), rows


def _is_over_or_under(ego_z_m: Floats, ego_height_m: float, z_m: Floats, height_m: Floats) -> Mask:
    """Return where an outline lies above or below the ego. A height of exactly 0 is one that was not stated."""
    is_stated = (ego_z_m != 0.0) & (z_m != 0.0)
    apart = np.abs(z_m - ego_z_m) - (height_m + ego_height_m) / 2.0
    above_or_below: Mask = is_stated & (apart > 0.0)
    return above_or_below
