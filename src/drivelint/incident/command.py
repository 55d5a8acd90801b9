"""Writes the commands that reproduce a finding and its sheet from the log and the map."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint import catalogue
from drivelint.engine.profiles import DEFAULT_PROFILES
from drivelint.reasons.signals import SIGNALS_OF_FEW_LOGS

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    import pyarrow as pa

    from drivelint.incident.finding import NamedFinding
    from drivelint.result.request import RunRequest


def reproducing_commands(
    run_options: RunRequest, finding: NamedFinding, rule_ids: Sequence[str], named_rule_ids: Collection[str] = ()
) -> list[str]:
    """Return two commands: the check of the finding's log by the rules of the run, and the report. Files are named without folders.

    `rule_ids`: the rules of the run; `named_rule_ids`: those that the user selected by their id.
    """
    row, drive = finding.row, finding.drive
    words = ["drivelint", "check", drive["file_name"]]
    if run_options.map is not None:
        words += ["--map", run_options.map.name]
    elif run_options.map_dir is not None:
        words += ["--map", drive["map_name"] or "MAP"]
    words += _log_and_map_options(run_options)
    if row["ego_id"]:
        words += ["--ego", row["ego_id"] if len(drive["exposure"]) == 1 else "all"]
    words += rule_selection_options(run_options, rule_ids, named_rule_ids)
    name = row["finding_id"]
    return [
        _shell_command([*words, "--out", "again"]),
        _shell_command(["drivelint", "report", "again", "--incident", name]),
    ]


def rule_selection_options(
    run_options: RunRequest, rule_ids: Sequence[str], named_rule_ids: Collection[str] = ()
) -> list[str]:
    """Return the options that select the rules, profiles and parameters of a run. Folders are given without their parent folders."""
    words = _shortest_rules_options(run_options, rule_ids, named_rule_ids)
    for profile in run_options.profiles if tuple(run_options.profiles) != tuple(DEFAULT_PROFILES) else ():
        words += ["--profile", profile]
    for setting in run_options.params:
        words += ["--param", setting]
    for folder in run_options.rules_dirs:
        words += ["--rules-dir", folder.name]
    return words


def _shortest_rules_options(
    run_options: RunRequest, rule_ids: Sequence[str], named_rule_ids: Collection[str]
) -> list[str]:
    """Return the shortest options that select these rules, and by their ids the named rules whose signals few logs have."""
    known_rules, wanted_ids = catalogue.load_rules(run_options.rules_dirs), set(rule_ids)
    rules = [known_rules[rule_id] for rule_id in sorted(wanted_ids & known_rules.keys())]
    # if its id does not select it, such a rule does not apply instead of being unknown
    of_few_logs = [rule.id for rule in rules if SIGNALS_OF_FEW_LOGS & set(rule.needed_signals)]
    named_of_few_logs = [rule_id for rule_id in of_few_logs if rule_id in named_rule_ids]
    by_ids = _rules_option_words(sorted(wanted_ids))
    candidates = [by_ids] if named_of_few_logs == of_few_logs else []
    packs = sorted({rule.pack for rule in rules})
    stable = sorted({rule.pack for rule in rules if rule.status == "stable"})
    # without --rules, the stable rules are selected; with a name alone, only that rule
    bases = [
        *([] if named_of_few_logs else [[]]),
        *([pack] for pack in packs),
        *([f"{pack},status:stable"] for pack in stable),
    ]
    for include in ([*base, *named_of_few_logs] for base in bases):
        selected = {rule.id for rule in catalogue.select_rules(known_rules, include, ())}
        if wanted_ids <= selected:
            left_out = (word for rule_id in sorted(selected - wanted_ids) for word in ("--ignore", rule_id))
            candidates.append([*_rules_option_words(include), *left_out])
    return min(candidates or [by_ids], key=len)


def rule_ids_named_by_user(rules_of_run: pa.Table) -> list[str]:
    """Return the ids of the rules that the user selected by their ids. `rules_of_run`: rows of the table `rule`."""
    return [row["rule_id"] for row in rules_of_run.to_pylist() if row["is_named"]]


def _rules_option_words(names: Sequence[str]) -> list[str]:
    return [word for name in names for word in ("--rules", name)]


def _log_and_map_options(run_options: RunRequest) -> list[str]:
    """Return the options about the log and its map that differ from their defaults."""
    words: list[str] = []
    if run_options.mapping is not None:
        words += [
            "--mapping",
            Path(run_options.mapping).name if Path(run_options.mapping).is_file() else run_options.mapping,
        ]
    for name, pair in (("--map-offset", run_options.map_offset), ("--map-origin", run_options.map_origin)):
        if pair is not None:
            words.append(f"{name}={pair[0]:.12g},{pair[1]:.12g}")
    if run_options.handedness != "auto":
        words += ["--handedness", run_options.handedness]
    if run_options.topic is not None:
        words += ["--topic", run_options.topic]
    if run_options.sensor_range_m is not None:
        words += ["--sensor-range", f"{run_options.sensor_range_m:.12g}"]
    if run_options.visibility != "line-of-sight":
        words += ["--visibility", run_options.visibility]
    if run_options.ego_size is not None:
        words += ["--ego-size", ",".join(f"{value:.12g}" for value in run_options.ego_size)]
    for condition in run_options.env:
        words += ["--env", condition]
    return words


def _shell_command(words: list[str]) -> str:
    return " ".join(shlex.quote(word) for word in words)
