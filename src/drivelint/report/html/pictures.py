"""Pictures from the logs' cameras for the pages: by moment and camera, each with its time relative to the moment."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any, Final

from markupsafe import Markup

from drivelint.result.counts import group_rows

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pyarrow as pa

Moment = tuple[str, int]
_MINUS: Final = "\u2212"
_SAME_MOMENT_TOLERANCE_NS: Final = 5_000_000
"""A frame nearer to the moment than this is labelled "at the moment": times are printed in hundredths of a second."""


def cameras_by_moment(pictures: pa.Table) -> dict[Moment, list[dict[str, Any]]]:
    """Return, by drive and time, the cameras, each with its pictures in time order. `pictures`: the table `picture`."""
    rows = pictures.to_pylist()
    cameras: dict[Moment, list[dict[str, Any]]] = {}
    for (drive_id, t_ns, _, camera), camera_rows in group_rows(
        rows, lambda row: (row["drive_id"], row["t_ns"], row["camera_no"], row["camera"])
    ).items():
        cameras.setdefault((drive_id, t_ns), []).append(
            {
                "camera": camera,
                "shots": [_picture_for_page(row) for row in sorted(camera_rows, key=lambda row: row["t_frame_ns"])],
            }
        )
    return cameras


def add_pictures(
    worst: dict[str, Any] | None, sections: Sequence[dict[str, Any]], cameras: Mapping[Moment, list[dict[str, Any]]]
) -> None:
    """Add the pictures to the moments of a page, each picture only once; other moments at the same time link to it.

    The worst moment gets its pictures first.
    """
    anchors: dict[Moment, str] = {}
    if worst is not None:
        row = worst["line"].row
        moment = row["drive_id"], row["t_worst_ns"]
        worst["cameras"] = cameras.get(moment, [])
        if worst["cameras"]:
            anchors[moment] = "worst"
    for section in sections:
        for incident in section["moments"]:
            moment = section["drive_id"], incident["t_ns"]
            if moment in anchors:
                incident["pictured"] = anchors[moment]
            elif moment in cameras:
                incident["cameras"], anchors[moment] = cameras[moment], incident["anchor"]


def _picture_for_page(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "src": Markup("data:image/jpeg;base64,") + Markup(base64.b64encode(row["jpeg"]).decode()),  # noqa: S704 - no special characters
        "width": row["width_px"],
        "height": row["height_px"],
        "is_at": row["shot"] == "at",
        "told": _offset_from_moment_text(row["t_frame_ns"] - row["t_ns"]),
    }


def _offset_from_moment_text(off_ns: int) -> str:
    """Return in words when a frame was taken, relative to the moment."""
    if abs(off_ns) < _SAME_MOMENT_TOLERANCE_NS:
        return "at the moment"
    return f"{'+' if off_ns > 0 else _MINUS}{abs(off_ns) / 1e9:.2f} s"
