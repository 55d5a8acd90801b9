"""Speed limits that only signs give: from the sign along its lane to the next sign or junction.

Beyond a junction nothing is known: nations differ in whether the limit goes on there. Where the map records a limit of the
lane or of the road, that is taken, and no sign is looked at.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from drivelint.formats.opendrive.network import SPEED_UNITS_MPS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.links import Link
    from drivelint.road.tables import Rows

LIMIT_BEGINS = frozenset({"speed_limit", "speed_zone"})
LIMIT_ENDS = LIMIT_BEGINS | {
    "speed_limit_end", "speed_zone_end", "restrictions_end", "town_entrance", "town_exit", "motorway", "motorway_end",
    "expressway", "expressway_end",
}  # fmt: skip


class _Stretch(NamedTuple):
    """What is left to go along: from where on a lanelet, under which limit (m/s; None: it cannot be read)."""

    lanelet_id: str
    start_m: float
    limit_mps: float | None


def sign_limits(lanes: Sequence[Lanelet], joined: Sequence[Link], signals: Rows, recorded: Rows) -> Rows:
    """Return the rows of `speed_limit` that signs give for lanelets without a recorded one."""
    by_id = {lane.lanelet_id: lane for lane in lanes}
    silent = by_id.keys() - {row["lanelet_id"] for row in recorded}
    after: dict[str, list[str]] = {}
    for a, b in joined:
        after.setdefault(a.lanelet_id, []).append(b.lanelet_id)
    posts: dict[str, list[float]] = {}
    for row in signals:
        if row["kind"] in LIMIT_ENDS:
            posts.setdefault(row["lanelet_id"], []).append(row["lane_s_m"])
    todo = [_Stretch(row["lanelet_id"], row["lane_s_m"], _limit(row)) for row in signals if row["kind"] in LIMIT_BEGINS]
    rows: Rows = []
    seen: set[_Stretch] = set()
    while todo:
        stretch = todo.pop()
        if stretch in seen or stretch.lanelet_id not in silent:
            continue
        seen.add(stretch)
        lane = by_id[stretch.lanelet_id]
        posted = min((s for s in posts.get(stretch.lanelet_id, ()) if s > stretch.start_m), default=None)
        end = lane.line.length if posted is None else posted
        if end > stretch.start_m:
            source = "unread" if stretch.limit_mps is None else "sign"
            rows.append({
                "lanelet_id": stretch.lanelet_id, "s_start_m": stretch.start_m, "s_end_m": end,
                "limit_mps": stretch.limit_mps, "source": source,
            })  # fmt: skip
        if posted is None:
            todo += [
                _Stretch(name, 0.0, stretch.limit_mps)
                for name in after.get(stretch.lanelet_id, ())
                if by_id[name].road.junction_id is None and 0.0 not in posts.get(name, ())
            ]
    return sorted(rows, key=lambda r: (r["lanelet_id"], r["s_start_m"], r["s_end_m"], r["limit_mps"] or 0.0))


def _limit(row: Mapping[str, Any]) -> float | None:
    """Return the limit on a sign (m/s); None: it has no number or no unit, or it changes."""
    unit = SPEED_UNITS_MPS.get(row["unit"] or "")
    return None if unit is None or row["value"] is None or row["dynamic"] else float(row["value"]) * unit
