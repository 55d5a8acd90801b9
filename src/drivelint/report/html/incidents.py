"""Incidents: the findings and near misses of one ego at one time, with plan view, measured values and actors."""

from __future__ import annotations

from collections import Counter, defaultdict
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.engine.robustness.copies import MeasurementErrors
from drivelint.phrases import ego_name
from drivelint.report.html.anchors import anchor
from drivelint.report.html.contact import speeds_before_contact
from drivelint.report.html.margin_series import margin_series
from drivelint.report.html.plan_view import plan_view
from drivelint.report.html.replay import centiseconds
from drivelint.report.html.svg import svg_number
from drivelint.report.same_contact import other_certainty_words
from drivelint.report.worst_first import moment_ns, when
from drivelint.result.certainty import POSSIBLE, certainty
from drivelint.result.counts import SEVERITIES, group_rows
from drivelint.result.text import breach_title, measure, non_breaking, number, seconds, utc_at

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from drivelint.report.html.baseline_status import BaselineStatus
    from drivelint.report.html.road import DrawnMaps

    Row = Mapping[str, Any]
    Key = tuple[str, str, int]

_SENSE_WORDS: Final = {">": "more than", ">=": "at least", "<": "less than", "<=": "at most"}
_DANGER_SPACE_TAG: Final = "danger_space"
"""The tag of rules whose plan views show danger spaces."""
MAX_INCIDENTS_IN_DRIVE_SUMMARY: Final = 6
"""The summary of a drive, which the printed report shows, has at most this many incidents."""


class FindingLine(NamedTuple):
    """One finding (`fail`) or near miss (`near`) as the page shows it, in the table and in its incident.

    `time`: the worst time, at which the plan view is drawn; `when`: the time that is printed, see `worst_first.when`.
    """

    row: Row
    rule: Row
    kind: str
    anchor: str
    href: str
    keys: str
    time: str
    when: str
    stretch: str
    required: str
    gauge: dict[str, str] | None
    sentence: str
    course: dict[str, Any] | None
    standing: BaselineStatus | None
    sure: dict[str, str] | None


def finding_line(
    row: Row,
    kind: str,
    rule: Row,
    start_ns: int,
    *,
    has_section: bool,
    course: Row | None,
    status: BaselineStatus | None,
    same_contact_findings: Sequence[Row] = (),
) -> FindingLine:
    """Return a finding or near miss as the page shows it.

    `has_section`: its drive has a section in the page; `course`: its row of the table `course`; `same_contact_findings`: other findings
    of the same contact.
    """
    unit, long = row["unit"], row["t_end_ns"] is not None and row["t_end_ns"] != row["t_start_ns"]
    sense = _SENSE_WORDS.get(rule["sense"])
    required = number(row["required"], unit)
    if sense is not None:
        required = "none" if row["required"] == 0 and rule["sense"][0] == "<" else f"{sense} {non_breaking(required)}"
    sure = certainty_on_page(row, same_contact_findings) if kind == "fail" else None
    filter_keys = [status.filter_key] if status else []
    filter_keys += [f"sure-{sure['kind']}"] if sure and sure["kind"] else []
    moment = moment_ns(row, {rule["rule_id"]: rule})
    first_contact = "" if moment == row["t_worst_ns"] else f"; first contact at {seconds(moment, start_ns)}"
    place = anchor("finding", row["finding_id"]) if has_section and kind == "fail" else ""
    return FindingLine(
        row,
        rule,
        kind,
        anchor=place,
        href=f"#{place or anchor('moment', *incident_key(row))}" if has_section else "",
        keys=" ".join((kind, row["severity"], rule["pack"], *filter_keys)),
        time=non_breaking(seconds(row["t_worst_ns"], start_ns)),
        when=when(row, {rule["rule_id"]: rule}, start_ns).replace(" s", non_breaking(" s")),
        stretch=f"{seconds(row['t_start_ns'], start_ns)} to {seconds(row['t_end_ns'], start_ns)}" if long else "",
        required=required,
        gauge=_gauge_positions(row["observed"], row["required"]),
        sentence=(_measurement_sentence(row, rule, required) if sense else row["reason"]) + first_contact,
        course=None if course is None else margin_series(course, row["t_worst_ns"], unit, start_ns),
        standing=status,
        sure=sure,
    )


def _measurement_sentence(row: Row, rule: Row, required: str) -> str:
    """Return a sentence with the observed value, the required value, and the reason that the rule gives."""
    quantity = f"{rule['observes']} " if rule["observes"] else ""
    sentence = f"{quantity}{measure(row['observed'], row['unit'])}, must be {required}"
    return sentence if row["reason_measures"] else f"{sentence} ({row['reason']})"


def certainty_on_page(finding: Row, same_contact_findings: Sequence[Row] = ()) -> dict[str, str]:
    """Return whether a finding is sure or possible (`kind`, '' if no copies were judged), and in how many copies it stays.

    Copies are copies of the drive with assumed recording errors. `same_contact_findings`: other findings of the same contact.
    """
    kind = certainty(finding)
    if kind is None:
        return {"kind": "", "label": "not tested", "why": "no copies with assumed errors were judged"}
    of = f"{finding['n_stays']} of {finding['n_copies']}"
    only = "only " if kind == POSSIBLE else ""
    why = f"it is also a finding in {only}{of} copies of the drive with assumed errors ({MeasurementErrors().standard_deviations_text})"
    if other_words := other_certainty_words(finding, same_contact_findings):
        why += f"; {other_words}"
    return {"kind": kind, "label": f"{kind}, {of}", "why": why}


def incident_key(row: Row) -> Key:
    """Return the key (drive, ego, time) of the incident that a finding or near miss belongs to."""
    return row["drive_id"], row["ego_id"], row["t_worst_ns"]


def _ranks_in_summary(lines: Iterable[FindingLine]) -> dict[Key, int]:
    """Return the incidents of one drive that its summary shows, with their ranks from 0, the worst.

    The summary shows the worst incident of each rule, the most severe rules first.
    """
    first: dict[str, tuple[int, float, Key]] = {}
    for row in (line.row for line in lines if line.kind == "fail"):
        ratio = 0.0 if not row["required"] or row["margin"] is None else row["margin"] / abs(row["required"])
        worst = (SEVERITIES.index(row["severity"]), ratio, incident_key(row))
        first[row["rule_id"]] = min(first.get(row["rule_id"], worst), worst)
    order = list(dict.fromkeys(at for _, _, at in sorted(first.values())))
    return {at: n for n, at in enumerate(order[:MAX_INCIDENTS_IN_DRIVE_SUMMARY])}


def incidents(lines: Sequence[FindingLine], views: Mapping[Key, dict[str, Any]], drive: Row) -> list[dict[str, Any]]:
    """Return the incidents of one drive in time order: the findings and near misses of one ego at one time.

    `cards`: the findings and near misses by rule; `plan`: the plan view, or None; `t`: hundredths of a second since the drive's start.
    `leading`: whether the drive's summary shows the incident, `rank`: its rank there, from 0, the worst.
    `on_earth`: a finding with known longitude and latitude, or None; `t_utc`: the time in UTC, None if the log does not give it.
    `cameras`, `pictured`: empty; `add_pictures` fills them in. `drive`: a row of the result's drives.
    """
    groups, leading = group_rows(lines, lambda line: incident_key(line.row)), _ranks_in_summary(lines)
    return [
        _incident(at, group, drive)
        | {"plan": views.get(at), "leading": at in leading, "rank": leading.get(at)}
        | {"cameras": [], "pictured": ""}
        for at, group in sorted(groups.items(), key=lambda item: (item[0][2], item[0][1]))
    ]


def plan_views(
    lines: Iterable[FindingLine],
    scenes: Mapping[Key, Row],
    spaces: Mapping[Key, list[Row]],
    road: DrawnMaps,
    starts: Mapping[str, int],
    *,
    max_views: int,
) -> dict[Key, dict[str, Any]]:
    """Return the plan views of the first `max_views` incidents of `lines`. `before`: the speeds before a contact, in words."""
    lines_by_incident = group_rows(lines, lambda line: incident_key(line.row))
    views: dict[Key, dict[str, Any]] = {}
    for at, group in [(at, group) for at, group in lines_by_incident.items() if at in scenes][:max_views]:
        about = any(_DANGER_SPACE_TAG in line.rule["tags"] for line in group)
        contact = next((line.row for line in group if line.kind == "fail" and CONTACT_TAG in line.rule["tags"]), None)
        before = None if contact is None else speeds_before_contact(scenes[at], contact, starts.get(at[0], 0))
        picture = plan_view(scenes[at], road, _object_ids(group), spaces.get(at, []) if about else [])
        views[at] = picture | {"before": before["words"] if before else ""}
    return views


def _object_ids(lines: Iterable[FindingLine]) -> set[str]:
    return {line.row["object_id"] for line in lines if line.row["object_id"] is not None}


def _incident(at: Key, incident_lines: Sequence[FindingLine], drive: Row) -> dict[str, Any]:
    failed = [line for line in incident_lines if line.kind == "fail"]
    title: Callable[[Row], str] = breach_title if failed else itemgetter("title")
    gravest = sorted(failed or incident_lines, key=lambda line: SEVERITIES.index(line.row["severity"]))
    cards = group_rows(incident_lines, lambda line: line.row["rule_id"])
    return {
        "anchor": anchor("moment", *at),
        "time": incident_lines[0].time,
        "t_ns": at[2],
        "t": centiseconds(at[2], drive["t_start_ns"] or 0),
        "t_utc": utc_at(at[2], drive),
        "keys": " ".join(sorted({name for line in incident_lines for name in line.keys.split()})),
        "ego_id": at[1],
        "objects": sorted(_object_ids(incident_lines)),
        "kind": "fail" if failed else "near",
        "severity": gravest[0].row["severity"],
        "titles": list(dict.fromkeys(title(line.rule) for line in gravest)),
        "on_earth": next((line.row for line in failed if None not in {line.row["lon"], line.row["lat"]}), None),
        "cards": [(lines[0].rule, lines) for _, lines in sorted(cards.items(), key=_card_sort_key)],
    }


def _card_sort_key(item: tuple[str, Sequence[FindingLine]]) -> tuple[bool, int, str]:
    rule_id, lines = item
    return lines[0].kind != "fail", SEVERITIES.index(lines[0].row["severity"]), rule_id


def _gauge_positions(observed: float | None, required: float | None) -> dict[str, str] | None:
    """Return a bar from zero to the observed value, and the position of the required value, in percent of the drawing's width."""
    if observed is None or required is None or not max(abs(observed), abs(required)) < float("inf"):
        return None
    low, high = min(0.0, observed, required), max(0.0, observed, required)
    if high == low:
        return None
    low, high = low - 0.06 * (high - low), high + 0.06 * (high - low)

    def position_percent(value: float) -> float:
        return 100 * (value - low) / (high - low)

    start, end = sorted((position_percent(0.0), position_percent(observed)))
    places = {
        "zero": position_percent(0.0),
        "x": start,
        "w": max(end - start, 0.4),
        "required": position_percent(required),
    }
    return {name: f"{svg_number(value)}%" for name, value in places.items()}


def involved_actors(lines: Sequence[FindingLine], scenes: Mapping[Key, Row]) -> list[dict[str, Any]]:
    """Return the egos and objects of one drive's findings and near misses, in words, from their scenes; egos first.

    `n`: the number of findings about the actor.
    """
    findings: Counter[tuple[bool, str]] = Counter()
    actor_rows: dict[str, list[Row]] = defaultdict(list)
    for line in lines:
        scene = scenes.get(incident_key(line.row))
        actors = {actor["actor_id"]: actor for actor in scene["actors"]} if scene else {}
        for is_object, actor_id in ((False, line.row["ego_id"]), (True, line.row["object_id"])):
            if actor_id is not None:
                findings[is_object, actor_id] += line.kind == "fail"
                if actor_id in actors:
                    actor_rows[actor_id].append(actors[actor_id])
    order = sorted(findings.items(), key=lambda item: (item[0][0], -item[1], item[0][1]))
    return [
        {
            "name": f"object {actor_id}" if is_object else ego_name(actor_id),
            "what": _actor_class_words(actor_rows[actor_id]),
            "sized": next((a for a in actor_rows[actor_id] if None not in {a["length_m"], a["width_m"]}), None),
            "speeds": [a["speed_mps"] for a in actor_rows[actor_id] if a["speed_mps"] is not None],
            "n": n,
        }
        for (is_object, actor_id), n in order
        if not (is_object and (False, actor_id) in findings)
    ]


def _actor_class_words(actors: Sequence[Row]) -> str:
    return next((a["actor_class"] for a in actors if a["actor_class"]), "of unknown kind").replace("_", " ")
