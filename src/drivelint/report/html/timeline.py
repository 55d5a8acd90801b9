"""The timeline of one ego in one drive: a row per rule and profile with the judged times and the findings.

Positions on the time axis are percentages, so that the drawing fits any width without distorting its marks.
"""

from __future__ import annotations

from operator import itemgetter
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.report.html.anchors import anchor
from drivelint.report.html.reasons import VerdictReason, can_missing_data_be_provided, summarise_reasons, verdict_reason
from drivelint.report.html.svg import percent
from drivelint.result.counts import SEVERITIES, group_rows
from drivelint.result.text import number, seconds

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from drivelint.result.text import Row

_VERDICTS_WORST_FIRST: Final = ("fail", "error", "unknown", "pass", "not_applicable")
_VERDICTS_IN_DRAWING_ORDER: Final = ("pass", "unknown", "error", "fail")  # the most important verdict is drawn last
_TICK_STEPS_S: Final = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600)
_MOST_TICKS: Final = 9
_LEAST_BAND_WIDTH_PERCENT: Final = 0.35  # percent: a shorter period is drawn as a mark


class TimelineRow(NamedTuple):
    """One row of a timeline: a rule and profile, its worst verdict, and its bars.

    `bands`: judged periods, or moments (width `w` is empty); `marks`: findings, with their links, and near misses.
    """

    rule_id: str
    title: str
    profile: str | None
    verdict: str
    keys: str
    bands: list[dict[str, str]]
    marks: list[dict[str, str]]


class FoldedRules(NamedTuple):
    """Rules without bars that share one reason: they are not applicable, or data are missing."""

    verdict: str
    kind: tuple[str, ...]
    reasons: dict[tuple[str, str], set[VerdictReason]]
    """The reasons of each rule, by its title and the link to it."""

    @property
    def rules(self) -> list[tuple[str, str]]:
        """The titles and links of the rules, in the order of their links."""
        return sorted(self.reasons, key=lambda rule: rule[1])

    @property
    def why(self) -> str:
        """The reason, in words."""
        return summarise_reasons(set[VerdictReason]().union(*self.reasons.values()))


class Timeline(NamedTuple):
    """All rows of one ego, the axis (name and width of its grid, labels), and the rules without bars."""

    ego_id: str
    grid: str
    step: str
    ticks: list[tuple[str, str]]
    rows: list[TimelineRow]
    folded: list[FoldedRules]
    n: dict[str, int]


class TimeAxis(NamedTuple):
    """The time axis of a drive, in percent of its duration."""

    start_ns: int
    duration_s: float

    def at(self, t_ns: int) -> float:
        """Return the position of a time, from 0 to 100."""
        return min(max((t_ns - self.start_ns) / 1e7 / self.duration_s, 0.0), 100.0)

    def tick_step_s(self) -> int:
        """Return the time between two ticks in seconds."""
        return next((s for s in _TICK_STEPS_S if self.duration_s / s <= _MOST_TICKS), _TICK_STEPS_S[-1])

    def ticks(self) -> list[tuple[str, str]]:
        """Return positions and labels of the axis."""
        step = self.tick_step_s()
        return [(percent(100 * t / self.duration_s), str(t)) for t in range(0, int(self.duration_s) + 1, step)]


def timelines(
    drive: Row,
    verdicts: Iterable[Row],
    findings: Sequence[Row],
    rules: Mapping[str, Row],
    filter_key_of_anchor: Mapping[str, str],
) -> list[Timeline]:
    """Return a timeline for each ego of one drive, in the order of the verdicts.

    `filter_key_of_anchor`: the anchors of the findings on the page, each with its key for the page's filter by gate status ('' without a
    gate).
    """
    clock = TimeAxis(drive["t_start_ns"] or 0, max(drive["duration_s"] or 0.0, 1e-3))
    findings_by_ego = group_rows(findings, lambda row: row["ego_id"])
    return [
        _timeline(ego_verdicts, findings_by_ego.get(ego, []), rules, filter_key_of_anchor, clock)
        for ego, ego_verdicts in group_rows(verdicts, lambda row: row["ego_id"]).items()
    ]


def _timeline(
    verdicts: Sequence[Row],
    findings: Sequence[Row],
    rules: Mapping[str, Row],
    filter_key_of_anchor: Mapping[str, str],
    clock: TimeAxis,
) -> Timeline:
    """Return the timeline of one ego."""
    of: Callable[[Row], tuple[str, str | None]] = itemgetter("rule_id", "profile")
    ego, findings_by_key = verdicts[0]["ego_id"], group_rows(findings, of)
    rows: list[TimelineRow] = []
    folded: dict[tuple[str, tuple[str, ...]], dict[tuple[str, str], set[VerdictReason]]] = {}
    for key, group in group_rows(verdicts, of).items():
        rule_id, profile = key
        rule, href = rules[rule_id], "#" + anchor("rule", rule_id)
        worst = min((row["verdict"] for row in group), key=_VERDICTS_WORST_FIRST.index)
        if worst == "not_applicable" or all(_is_unknown_for_lack_of_data(row) for row in group):
            reason = verdict_reason(group[0])
            folded.setdefault((worst, reason.kind), {}).setdefault((rule["title"], href), set()).add(reason)
            continue
        marks = [_finding_mark(row, filter_key_of_anchor, clock) for row in findings_by_key.get(key, [])]
        near = [_near_miss_mark(row, clock) for row in group if row["near_miss"]]
        stands = sorted(
            {filter_key_of_anchor.get(anchor("finding", row["finding_id"]), "") for row in findings_by_key.get(key, [])}
        )
        keys = " ".join((worst, "near" if near else "", rule["severity"], rule["pack"], *stands))
        rows.append(TimelineRow(rule_id, rule["title"], profile, worst, keys, _bands(group, clock), marks + near))
    rows.sort(
        key=lambda lane: (_VERDICTS_WORST_FIRST.index(lane.verdict), SEVERITIES.index(rules[lane.rule_id]["severity"]))
    )
    order = sorted(
        folded.items(), key=lambda item: (_VERDICTS_WORST_FIRST.index(item[0][0]), -len(item[1]), item[0][1])
    )
    return Timeline(
        ego,
        anchor("grid", verdicts[0]["drive_id"], ego),
        f"{clock.tick_step_s() / clock.duration_s:.5f}",
        clock.ticks(),
        rows,
        [FoldedRules(*key, why) for key, why in order],
        {verdict: sum(lane.verdict == verdict for lane in rows) for verdict in _VERDICTS_WORST_FIRST},
    )


def empty_timeline(ego_id: str) -> Timeline:
    """Return the timeline of an ego without verdicts."""
    return Timeline(ego_id, "", "0", [], [], [], dict.fromkeys(_VERDICTS_WORST_FIRST, 0))


def separate_shared_rules(ego_timelines: Sequence[Timeline]) -> tuple[list[FoldedRules], list[Timeline]]:
    """Return the folded rules that all egos share, and the timelines without these rules."""
    common = {(f.verdict, f.kind): f.reasons for f in ego_timelines[0].folded} if ego_timelines else {}
    for t in ego_timelines[1:]:
        ego_reasons = {(f.verdict, f.kind): f.reasons for f in t.folded}
        common = {
            key: {
                rule: reasons | ego_reasons[key][rule]
                for rule, reasons in why.items()
                if rule in ego_reasons.get(key, {})
            }
            for key, why in common.items()
        }
    common = {key: why for key, why in common.items() if why}

    def unshared_rules(t: Timeline) -> list[FoldedRules]:
        left = [
            f._replace(reasons={rule: why for rule, why in f.reasons.items() if rule not in common.get(f[:2], {})})
            for f in t.folded
        ]
        return [f for f in left if f.reasons]

    return [FoldedRules(*key, why) for key, why in common.items()], [
        t._replace(folded=unshared_rules(t)) for t in ego_timelines
    ]


def _is_unknown_for_lack_of_data(verdict: Row) -> bool:
    """Return whether a verdict is unknown for the whole drive because data are missing that could be provided."""
    is_unknown = verdict["verdict"] == "unknown" and verdict["t_start_ns"] is None
    return bool(is_unknown and can_missing_data_be_provided(verdict["reason_code"]))


def _bands(verdicts: Sequence[Row], clock: TimeAxis) -> list[dict[str, str]]:
    """Return the judged periods as bands by verdict; touching periods of one verdict become one band."""
    bands = []
    for verdict in _VERDICTS_IN_DRAWING_ORDER:
        spans: list[tuple[float, float, set[VerdictReason]]] = []
        rows = [row for row in verdicts if row["verdict"] == verdict]
        for (start, end), reason in sorted((_judged_span_percent(row, clock), verdict_reason(row)) for row in rows):
            if spans and start <= spans[-1][1]:
                spans[-1] = (spans[-1][0], max(spans[-1][1], end), spans[-1][2] | {reason})
            else:
                spans.append((start, end, {reason}))
        for start, end, reasons in spans:
            why = "" if verdict in {"pass", "fail"} else f": {summarise_reasons(reasons)}"
            bands.append({"verdict": verdict, **_position_and_width(start, end), "title": f"{verdict}{why}"})
    return bands


def _judged_span_percent(row: Row, clock: TimeAxis) -> tuple[float, float]:
    """Return start and end of the judged period in percent of the drive.

    Without a period, both are the reference time; without that, they are 0 and 100.
    """
    if row["t_start_ns"] is None:
        return (0.0, 100.0) if row["t_ref_ns"] is None else (clock.at(row["t_ref_ns"]),) * 2
    return clock.at(row["t_start_ns"]), clock.at(row["t_end_ns"])


def _finding_mark(row: Row, anchors: Collection[str], clock: TimeAxis) -> dict[str, str]:
    place = anchor("finding", row["finding_id"])
    start, end = clock.at(row["t_start_ns"]), clock.at(row["t_end_ns"])
    href = f"#{place}" if place in anchors else ""
    return {"kind": "fail", **_position_and_width(start, end), "href": href, "title": _mark_title(row, clock)}


def _near_miss_mark(row: Row, clock: TimeAxis) -> dict[str, str]:
    at = clock.at(row["t_worst_ns"])
    return {"kind": "near", **_position_and_width(at, at), "title": f"near miss, {_mark_title(row, clock)}"}


def _position_and_width(start: float, end: float) -> dict[str, str]:
    return {"x": percent(start), "w": percent(end - start) if end - start > _LEAST_BAND_WIDTH_PERCENT else ""}


def _mark_title(row: Row, clock: TimeAxis) -> str:
    margin = "" if row["margin"] is None else f", margin {number(row['margin'], row['unit'])}"
    return f"{seconds(row['t_worst_ns'], clock.start_ns)}{margin}"
