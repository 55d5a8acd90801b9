"""Speed limits of lanelets: the limits of signs take precedence over the limits that lanes and roads record.

In OpenDRIVE, the speed of a road type is the default, that of a lane takes precedence over it, and limits from signals take precedence
over both. A sign applies from its position, along its lane, to the next sign or junction. It also applies on the following roads that
record no limit, or the same limit as the road of the sign; a different record is a new default. Beyond a junction, the sign's limit is not
used: nations differ in whether it continues there.

A sign that cannot be read (without number or unit, with a changing number, with a speed but an unknown code, or for some vehicles or hours
only) makes the default of the road type unknown. A limit that the lane itself records still applies: it may be that of the sign. In
OpenDRIVE, a number needs a unit; without one, it is read where the code of the sign leaves only one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from drivelint.formats.opendrive.network import SPEED_UNITS_MPS
from drivelint.formats.opendrive.semantics import CHANGING_BOARD_TYPES
from drivelint.phrases import escape_invisible
from drivelint.road.signcodes import speed_without_unit_kmh

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.formats.opendrive.lanelet import Lanelet
    from drivelint.formats.opendrive.links import Link
    from drivelint.road.quality import MapQuality
    from drivelint.road.tables import Rows

LIMIT_BEGIN_KINDS = frozenset({"speed_limit", "speed_zone"})
LIMIT_END_KINDS = LIMIT_BEGIN_KINDS | {
    "speed_limit_end", "speed_zone_end", "restrictions_end", "town_entrance", "town_exit", "motorway", "motorway_end",
    "expressway", "expressway_end",
}  # fmt: skip
_MIN_SPAN_M = 1e-6


class _SignStretch(NamedTuple):
    """A stretch of road still to be processed: its start on a lanelet, and the sign's limit (m/s; None: it cannot be read)."""

    lanelet_id: str
    start_m: float
    limit_mps: float | None


def speed_limit_rows(
    lanes: Sequence[Lanelet], links: Sequence[Link], signals: Rows, recorded_rows: Rows, quality: MapQuality
) -> Rows:
    """Return the rows of `speed_limit`. `recorded_rows`: the rows that lanes and roads record; `signals`: rows of `traffic_signal`."""
    _report_unread_signs(signals, quality)
    records: dict[str, Rows] = {lane.lanelet_id: [] for lane in lanes}
    for row in recorded_rows:
        records[row["lanelet_id"]].append(row)
    signed: dict[str, Rows] = {}
    for row in _sign_limit_rows(lanes, links, signals, records):
        signed.setdefault(row["lanelet_id"], []).append(row)
    rows: Rows = []
    contradicted = []
    for name, own_rows in records.items():
        of_signs = signed.get(name, [])
        sign_rows = [row for row in of_signs if row["source"] == "sign"]
        of_lane = [row for row in own_rows if row["source"] == "lane"]
        unread = [row for row in of_signs if row["source"] != "sign"]
        rows += sign_rows
        rows += [part for row in unread for part in _uncovered_parts(row, of_lane)]
        rows += [part for row in of_lane for part in _uncovered_parts(row, sign_rows)]
        rows += [part for row in own_rows if row["source"] != "lane" for part in _uncovered_parts(row, of_signs)]
        if any(_is_contradiction(sign, lane) for sign in sign_rows for lane in of_lane):
            contradicted.append(name)
    if contradicted:
        message = (
            f"signs state other limits than the lanes that they apply to, the first {contradicted[0]}: the limits "
            "of the signs are used"
        )
        quality.add("limit_contradicted", "info", contradicted[0], message, len(contradicted))
    return sorted(rows, key=lambda r: (r["lanelet_id"], r["s_start_m"], r["s_end_m"], r["limit_mps"] or 0.0))


def _sign_limit_rows(
    lanes: Sequence[Lanelet], links: Sequence[Link], signals: Rows, records: Mapping[str, Rows]
) -> Iterable[dict[str, Any]]:
    """Yield a row for each stretch of a lanelet to which a sign applies."""
    by_id = {lane.lanelet_id: lane for lane in lanes}
    after: dict[str, list[str]] = {}
    for a, b in links:
        after.setdefault(a.lanelet_id, []).append(b.lanelet_id)
    posts: dict[str, list[float]] = {}
    for row in signals:
        if row["kind"] in LIMIT_END_KINDS or _may_be_limit(row):
            posts.setdefault(row["lanelet_id"], []).append(row["lane_s_m"])
    todo = [
        _SignStretch(row["lanelet_id"], row["lane_s_m"], _sign_limit_mps(row))
        for row in signals
        if row["kind"] in LIMIT_BEGIN_KINDS or _may_be_limit(row)
    ]
    finished: set[_SignStretch] = set()
    while todo:
        stretch = todo.pop()
        if stretch in finished:
            continue
        finished.add(stretch)
        lane = by_id[stretch.lanelet_id]
        posted = min((s for s in posts.get(stretch.lanelet_id, ()) if s > stretch.start_m), default=None)
        end = lane.line.length if posted is None else posted
        if end > stretch.start_m:
            source = "unread" if stretch.limit_mps is None else "sign"
            yield {
                "lanelet_id": stretch.lanelet_id, "s_start_m": stretch.start_m, "s_end_m": end,
                "limit_mps": stretch.limit_mps, "source": source,
            }  # fmt: skip
        if posted is None:
            todo += [
                _SignStretch(name, 0.0, stretch.limit_mps)
                for name in after.get(stretch.lanelet_id, ())
                if by_id[name].road.junction_id is None
                and 0.0 not in posts.get(name, ())
                and (by_id[name].road is lane.road or _records_same_limit(records[stretch.lanelet_id], records[name]))
            ]


def _records_same_limit(before: Rows, behind: Rows) -> bool:
    """Return whether a lanelet records no limit, or at its start the limit that the lanelet before it records at its end."""
    last, first = (
        (row["limit_mps"], row["source"]) if row is not None else None
        for row in (
            max(before, key=lambda r: float(r["s_end_m"]), default=None),
            min(behind, key=lambda r: float(r["s_start_m"]), default=None),
        )
    )
    return first is None or first == last


def _uncovered_parts(row: Mapping[str, Any], covering_rows: Rows) -> Rows:
    """Return the parts of a row that the spans of `covering_rows` do not cover."""
    parts, at = [], float(row["s_start_m"])
    for start, end in sorted((float(covering["s_start_m"]), float(covering["s_end_m"])) for covering in covering_rows):
        if end <= at:
            continue
        parts.append((at, min(start, row["s_end_m"])))
        at = end
    parts.append((at, row["s_end_m"]))
    return [{**row, "s_start_m": a, "s_end_m": b} for a, b in parts if b - a > _MIN_SPAN_M]


def _is_contradiction(sign: Mapping[str, Any], lane: Mapping[str, Any]) -> bool:
    common = min(sign["s_end_m"], lane["s_end_m"]) - max(sign["s_start_m"], lane["s_start_m"])
    same = lane["limit_mps"] is not None and abs(sign["limit_mps"] - lane["limit_mps"]) < 0.1
    return common > _MIN_SPAN_M and not same


def _may_be_limit(row: Mapping[str, Any]) -> bool:
    """Return whether a sign that was not recognised has a speed, or is a board that may show one, and so may be a limit."""
    if row["type"] in CHANGING_BOARD_TYPES:
        return True
    return row["kind"] is None and row["value"] is not None and row["unit"] in SPEED_UNITS_MPS


def _sign_limit_mps(row: Mapping[str, Any]) -> float | None:
    """Return the limit on a sign (m/s); None: it cannot be read."""
    return None if _cause_unread(row) else _stated_mps(row)


def _cause_unread(row: Mapping[str, Any]) -> str | None:
    """Return why the limit on a sign cannot be read; None: it can."""
    if row["dynamic"] or row["type"] in CHANGING_BOARD_TYPES:
        return "what it shows changes"
    if row["kind"] is None:
        return "its code is not known"
    if row["value"] is None:
        return "it has no number, or does not always apply"
    return "its number has no known unit" if _stated_mps(row) is None else None


def _stated_mps(row: Mapping[str, Any]) -> float | None:
    if row["unit"]:
        unit = SPEED_UNITS_MPS.get(row["unit"])
        return None if unit is None else float(row["value"]) * unit
    kmh = speed_without_unit_kmh(row["country"] or "", row["type"] or "", row["subtype"] or "", row["value"])
    return None if kmh is None else kmh * SPEED_UNITS_MPS["km/h"]


def _report_unread_signs(signals: Rows, quality: MapQuality) -> None:
    """Report the signs whose limits cannot be read, by cause."""
    signs_by_cause: dict[str, set[str]] = {}
    for row in signals:
        cause = _cause_unread(row) if row["kind"] in LIMIT_BEGIN_KINDS or _may_be_limit(row) else None
        if cause is not None:
            signs_by_cause.setdefault(cause, set()).add(row["signal_id"])
    for cause, signs in sorted(signs_by_cause.items()):
        first = escape_invisible(min(signs)[:40])
        message = f"speed limit signs cannot be read (the first, {first}: {cause}): the limit is unknown where no lane records one"
        quality.add("limit_sign_unread", "info", None, message, len(signs))
