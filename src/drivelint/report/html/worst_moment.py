"""The worst moment of a result, which the page shows first: the finding, its certainty, the plan view, charts and evidence files."""

from __future__ import annotations

import shlex
from operator import itemgetter
from typing import TYPE_CHECKING, Any, Final, NamedTuple
from urllib.parse import quote

from drivelint.catalogue.header import CONTACT_TAG
from drivelint.report.html.contact import speeds_before_contact
from drivelint.report.html.incidents import incident_key
from drivelint.report.html.moment_charts import charts_below_plan_view
from drivelint.report.html.replay import centiseconds
from drivelint.result.text import breach_title, utc_at

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from drivelint.report.html.incidents import FindingLine, Key
    from drivelint.result.text import Row

_MOST_OTHER_RULE_TITLES: Final = 4


class MomentEvidence(NamedTuple):
    """The recordings around the findings: scenes and their plan views by moment, rows of the table `course` by finding."""

    scenes: Mapping[Key, Row]
    pictures: Mapping[Key, Mapping[str, Any]]
    courses: Mapping[tuple[Any, ...], Row]


def worst_moment(
    lines: Sequence[FindingLine], evidence: MomentEvidence, drives: Mapping[str, Row], folder: Path | None
) -> dict[str, Any] | None:
    """Return the worst moment with everything that the page shows about it; None if `lines` is empty.

    `lines`: sorted worst first, findings before near misses. A finding that the gate accepts (baseline or waiver) is chosen only if
    the gate accepts all. `is_new`: worse findings exist, but the gate accepts them; `let_through`: the gate accepts this finding too.
    """
    if not lines:
        return None
    line = next((entry for entry in lines if entry.standing is None or entry.standing.is_gating), lines[0])
    if line.kind == "near":
        line = lines[0]
    row, at = line.row, incident_key(line.row)
    drive, scene = drives[row["drive_id"]], evidence.scenes.get(at)
    start_ns = drive["t_start_ns"] or 0
    along = [entry for entry in lines if incident_key(entry.row) == at and entry.rule["rule_id"] != row["rule_id"]]
    touched = line.kind == "fail" and CONTACT_TAG in line.rule["tags"]
    return {
        "line": line,
        "is_new": line is not lines[0],
        "let_through": line.standing is not None and not line.standing.is_gating,
        "drive": drive,
        "t": centiseconds(row["t_worst_ns"], start_ns),
        "t_utc": utc_at(row["t_worst_ns"], drive),
        "plan": evidence.pictures.get(at),
        "strips": None
        if scene is None
        else charts_below_plan_view(
            scene, row, evidence.courses.get(finding_key(row)), line.rule["observes"], start_ns
        ),
        "before": speeds_before_contact(scene, row, start_ns) if touched and scene is not None else None,
        "kinds": {} if scene is None else {actor["actor_id"]: actor["actor_class"] for actor in scene["actors"]},
        "also": [
            (
                how,
                list(dict.fromkeys(title(entry.rule) for entry in along if entry.kind == kind))[
                    :_MOST_OTHER_RULE_TITLES
                ],
            )
            for kind, how, title in (
                ("fail", "also", breach_title),
                ("near", "also only just kept", itemgetter("title")),
            )
        ],
        "commands": _command_lines_for_finding(row),
        "files": _links_to_files(row, folder),
    }


def finding_key(row: Row) -> tuple[Any, ...]:
    """Return the key of a finding or near miss; its row of the table `course` has the same key."""
    values = (row[name] for name in ("drive_id", "ego_id", "rule_id", "profile", "object_id", "occurrence"))
    return (row.get("finding_id"), *values)


def _argument_for_explain_command(row: Row) -> str:
    """Return the argument that `explain` and `report --incident` accept for a finding or near miss."""
    return row.get("finding_id") or f"{row['rule_id']}@{row['drive_id']}"


def _command_lines_for_finding(row: Row) -> list[list[str]]:
    """Return the commands that explain and document a finding or near miss, each in parts, for the folder of a result."""
    explain = ["drivelint explain", shlex.quote(_argument_for_explain_command(row)), "--in ."]
    return [explain, ["drivelint report .", f"--incident {shlex.quote(_argument_for_explain_command(row))}"]]


def _links_to_files(row: Row, folder: Path | None) -> list[tuple[str, str]]:
    """Return the files beside the page that are about a finding, each as description and link."""
    if folder is None:
        return []
    beside = [("log that also contains the verdicts, for a viewer", f"annotated/{row['drive_id']}.mcap")]
    if "finding_id" in row:
        beside.append(("incident sheet, two pages on paper", f"incidents/{row['finding_id']}.html"))
    return [(words, quote(name)) for words, name in beside if (folder / name).is_file()]
