"""Who was involved in the findings of a drive: the egos and those that they met, as the incident report lists them."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Any

from drivelint.report.html.incidents import incident_key

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.report.html.incidents import FindingLine, Key
    from drivelint.result.text import Row


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
            "sized": next((a for a in seen[who] if None not in {a["length_m"], a["width_m"]}), None),
            "speeds": [a["speed_mps"] for a in seen[who] if a["speed_mps"] is not None],
            "n": n,
        }
        for (is_object, who), n in order
        if not (is_object and (False, who) in findings)
    ]


def _kind(actors: Sequence[Row]) -> str:
    return next((a["actor_class"] for a in actors if a["actor_class"]), "of unknown kind").replace("_", " ")
