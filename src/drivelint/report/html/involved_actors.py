"""Who was involved in the findings of a drive: the egos and those that they met, as the incident report lists them."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Any, Final

from drivelint.report.html.incidents import incident_key
from drivelint.result.text import NONE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.report.html.incidents import FindingLine, Key
    from drivelint.result.text import Row

_STANDS_MPS: Final = 0.1


def involved_actors(lines: Sequence[FindingLine], scenes: Mapping[Key, Row]) -> list[dict[str, Any]]:
    """Return the egos and objects of one drive's findings and near misses, in words, from their scenes; egos first.

    `n`: findings that are about it.
    """
    findings: Counter[tuple[bool, str]] = Counter()
    seen: dict[str, list[Row]] = defaultdict(list)
    for line in lines:
        scene = scenes.get(incident_key(line.row))
        actors = {actor["actor_id"]: actor for actor in scene["actors"]} if scene else {}
        for is_object, who in ((False, line.row["ego_id"]), (True, line.row["object_id"])):
            if who is not None:
                findings[is_object, who] += line.kind == "fail"
                if who in actors:
                    seen[who].append(actors[who])
    order = sorted(findings.items(), key=lambda item: (item[0][0], -item[1], item[0][1]))
    return [
        {
            "name": f"{'object' if is_object else 'ego'} {who}",
            "what": _kind(seen[who]),
            "size": _size(seen[who]),
            "speeds": _speeds(seen[who]),
            "n": n,
        }
        for (is_object, who), n in order
        if not (is_object and (False, who) in findings)
    ]


def _kind(actors: Sequence[Row]) -> str:
    return next((a["actor_class"] for a in actors if a["actor_class"]), "of unknown kind").replace("_", " ")


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
