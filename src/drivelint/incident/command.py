"""The commands that give a finding and its sheet again, for whoever has the log and the map."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint import catalogue
from drivelint.engine.profiles import DEFAULT_PROFILES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.incident.finding import NamedFinding
    from drivelint.result.request import RunRequest


def commands(asked: RunRequest, finding: NamedFinding, rule_ids: Sequence[str]) -> list[str]:
    """Return the check of the one log by the rules of the run, and the report. Files are named without their folders."""
    row, drive = finding.row, finding.drive
    words = ["drivelint", "check", drive["file_name"]]
    if asked.map is not None:
        words += ["--map", asked.map.name]
    elif asked.map_dir is not None:
        words += ["--map", drive["map_name"] or "MAP"]
    words += _options(asked)
    if row["ego_id"]:
        words += ["--ego", row["ego_id"] if len(drive["exposure"]) == 1 else "all"]
    words += of_rules(asked, rule_ids)
    name = row["finding_id"]
    return [_line([*words, "--out", "again"]), _line(["drivelint", "report", "again", "--incident", name])]


def of_rules(asked: RunRequest, rule_ids: Sequence[str]) -> list[str]:
    """Return the options of a run that say by which rules, profiles and parameters it judged. Of a path, only the last name is given."""
    words = _rules(asked, rule_ids)
    for profile in asked.profiles if tuple(asked.profiles) != tuple(DEFAULT_PROFILES) else ():
        words += ["--profile", profile]
    for setting in asked.params:
        words += ["--param", setting]
    for folder in asked.rules_dirs:
        words += ["--rules-dir", folder.name]
    return words


def _rules(asked: RunRequest, rule_ids: Sequence[str]) -> list[str]:
    """Return the shortest options that select these rules."""
    known, wanted = catalogue.load_rules(asked.rules_dirs), set(rule_ids)
    found = [[word for rule_id in sorted(wanted) for word in ("--rules", rule_id)]]
    for chosen in (
        [],
        *(["--rules", pack] for pack in sorted({known[rule_id].pack for rule_id in wanted & known.keys()})),
    ):
        selected = {rule.id for rule in catalogue.select_rules(known, chosen[1:], ())}
        if wanted <= selected:
            found.append([*chosen, *(word for rule_id in sorted(selected - wanted) for word in ("--ignore", rule_id))])
    return min(found, key=len)


def _options(asked: RunRequest) -> list[str]:
    """Return the options about the log and its map that are not as they are by default."""
    words: list[str] = []
    if asked.mapping is not None:
        words += ["--mapping", Path(asked.mapping).name if Path(asked.mapping).is_file() else asked.mapping]
    for name, pair in (("--map-offset", asked.map_offset), ("--map-origin", asked.map_origin)):
        if pair is not None:
            words.append(f"{name}={pair[0]:.12g},{pair[1]:.12g}")
    if asked.handedness != "auto":
        words += ["--handedness", asked.handedness]
    if asked.topic is not None:
        words += ["--topic", asked.topic]
    if asked.sensor_range_m is not None:
        words += ["--sensor-range", f"{asked.sensor_range_m:.12g}"]
    if asked.visibility != "line-of-sight":
        words += ["--visibility", asked.visibility]
    if asked.ego_size is not None:
        words += ["--ego-size", ",".join(f"{value:.12g}" for value in asked.ego_size)]
    for condition in asked.env:
        words += ["--env", condition]
    return words


def _line(words: list[str]) -> str:
    return " ".join(shlex.quote(word) for word in words)
