"""Who was involved in the findings of a drive: the egos and those that they met, as the incident report lists them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.result.text import NONE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    Row = Mapping[str, Any]
    Key = tuple[str, str, int]


_STANDS_MPS: Final = 0.1


class InvolvedActor(NamedTuple):
    """One actor in words; `n`: findings that are about it."""

    name: str
    what: str
    size: str
    speeds: str
    n: int


def involved_actors(drive_id: str, rows: Sequence[tuple[Row, Any]], scenes: Mapping[Key, Row]) -> list[InvolvedActor]:
    """Return the egos and objects of one drive's findings and near misses, from their scenes; egos first."""
    findings: dict[tuple[bool, str], int] = {}
    seen: dict[str, list[Row]] = {}
    for row, line in rows:
        actors = {
            a["actor_id"]: a for a in scenes.get((drive_id, row["ego_id"], row["t_worst_ns"]), {"actors": []})["actors"]
        }
        for is_object, who in ((False, row["ego_id"]), (True, row["object_id"])):
            if who is not None:
                findings[is_object, who] = findings.get((is_object, who), 0) + (line.kind == "fail")
                if who in actors:
                    seen.setdefault(who, []).append(actors[who])
    egos = {who for is_object, who in findings if not is_object}
    return [
        InvolvedActor(
            f"{'object' if is_object else 'ego'} {who}",
            next((a["actor_class"] for a in seen.get(who, []) if a["actor_class"]), "of unknown kind").replace(
                "_", " "
            ),
            _size(seen.get(who, [])),
            _speeds(seen.get(who, [])),
            n,
        )
        for (is_object, who), n in sorted(findings.items(), key=lambda item: (item[0][0], -item[1], item[0][1]))
        if not (is_object and who in egos)
    ]


def _size(actors: Sequence[Row]) -> str:
    known = [a for a in actors if a["length_m"] is not None and a["width_m"] is not None]
    return f"{known[0]['length_m']:.2f} m by {known[0]['width_m']:.2f} m" if known else NONE


def _speeds(actors: Sequence[Row]) -> str:
    speeds = [a["speed_mps"] for a in actors if a["speed_mps"] is not None]
    if not speeds:
        return NONE
    low, high = min(speeds), max(speeds)
    if high < _STANDS_MPS:
        return "standing"
    usual = f" (up to {high * 3.6:.0f} km/h, {high * 2.23694:.0f} mph)"
    return (f"{high:.1f} m/s" if high - low < _STANDS_MPS else f"{low:.1f} to {high:.1f} m/s") + usual
