"""The inputs of a run in one line: whether the map fits, whether logs are complete, and what was not judged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.drive.trace import ASIDE_OF_LANE_CHECK, ASSUMED_MOTION_CHECK, ASSUMED_SIZE_CHECK, TURNED_FRAME_CHECK
from drivelint.phrases import name_list, plural
from drivelint.reasons.signals import MISSING_PREFIX, UNRECORDED_PREFIX, signal_name
from drivelint.report.law import law_words
from drivelint.result import counts
from drivelint.result.model import (
    MAP_MISFIT_CODES,
    ego_absence_texts,
    gating_verdicts_lacking_signal,
    map_misfit_reason,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from collections.abc import Set as AbstractSet

    from drivelint.result.model import Result
    from drivelint.result.text import Row

LAW_LABEL: Final = "law"
"""The label of the note on the law, which the terminal prints in its first line instead."""
_ASSUMPTION_CHECKS: Final = (ASSUMED_SIZE_CHECK, TURNED_FRAME_CHECK)
_PLACED_CHECKS: Final = ("dropped_row", "malformed_row", "malformed_cell", "clock_jump")
"""The checks of a log's rows: their messages contain the place in the file."""
_SUFFIXES_WITHOUT_END_MARKER: Final = (".csv", ".osi", ".tsv", ".txt")
"""Formats without an end marker: a file that was cut off between two messages or lines looks complete."""
_MAX_LISTED_NAMES: Final = 2
_MAX_LISTED_PARAMETERS: Final = 4
_REMEDY_BY_SIGNAL: Final = {"ego size": ", which --ego-size gives"}
_NEVER_MOVES_CODE: Final = "ego_never_moves"
_NO_MAP_CODE: Final = "missing_map"
_EGO_COLUMNS: Final = ["drive_id", "ego_id"]


class InputNote(NamedTuple):
    """A note on the inputs, printed as `label: words`; `is_warning`: a verdict may be wrong or missing because of this input."""

    label: str
    words: str
    is_warning: bool


def input_notes(result: Result) -> list[InputNote]:
    """Return the notes on the inputs: law (if a rule implements a nation's law), parameters (if some are set), map, log, missing
    signals, parked egos, not judged."""
    drives = [drive for drive in result.drives.to_pylist() if drive["status"] == "judged"]
    law = [InputNote(LAW_LABEL, words, is_warning=False)] if (words := law_words(result)) else []
    return [
        *law,
        *_notes_on_parameters(result),
        _map_note(drives),
        _log_note(drives),
        *_notes_on_unrecorded_signals(result),
        *_notes_on_parked_egos(result),
        _not_judged_note(result, result.drives.num_rows - len(drives)),
    ]


def _notes_on_parameters(result: Result) -> list[InputNote]:
    """Return a note with the parameters of rules that were set for this run, and their values."""
    set_here = [
        f"{rule['rule_id']}.{param['name']} = {param['value']}{' ' + param['unit'] if param['unit'] not in {None, '1'} else ''}"
        for rule in result.rules.to_pylist()
        for param in rule["params"]
        if param["overridden"]
    ]
    words = f"set for this run: {name_list(set_here, _MAX_LISTED_PARAMETERS)}"
    return [InputNote("parameters", words, is_warning=True)] if set_here else []


def _map_note(drives: Sequence[Row]) -> InputNote:
    """Return the note on the maps on which the drives were judged, and on how many drives and egos they fit."""
    on_map = [drive for drive in drives if drive["map_name"] is not None]
    if not on_map:
        return InputNote("map", "none", is_warning=bool(drives))
    reasons = [reason for drive in on_map if (reason := map_misfit_reason(drive)) is not None]
    n = plural(len(on_map), "drive")
    words = f"{name_list(sorted({drive['map_name'] for drive in on_map}), _MAX_LISTED_NAMES)} fits {len(on_map) - len(reasons)} of {n}"
    off_egos, egos = sum(map(_n_egos_with_map_misfit, on_map)), sum(len(drive["exposure"]) for drive in on_map)
    if reasons:
        words += f" ({reasons[0]})"
    elif off_egos:
        words += f", but not {off_egos} of {egos} egos"
    aside = [
        check["message"] for drive in on_map for check in drive["quality"] if check["check_id"] == ASIDE_OF_LANE_CHECK
    ]
    if aside:
        words += f"{'; ' if off_egos else ', but '}{_far_from_lane_middle_words(aside, egos)}"
    if bare := len(drives) - len(on_map):
        words += f"; {plural(bare, 'drive')} without a map"
    return InputNote("map", words, is_warning=bool(off_egos or reasons or aside or bare))


def _far_from_lane_middle_words(messages: Sequence[str], egos: int) -> str:
    """Return words about the egos that drive far from the middle of their lanes.

    A shifted map would be wrong for most egos, not for a few.
    """
    if 2 * len(messages) < egos:
        return f"{len(messages)} of {egos} egos drive far from the middle of their lanes"
    far = f"{len(messages)} egos drive far from the middle of their lanes: the map may be shifted: correct it with --map-offset"
    return messages[0] if len(messages) == 1 else far


def _n_egos_with_map_misfit(drive: Row) -> int:
    egos = {ego["ego_id"] for ego in drive["exposure"]}
    return len(egos & {gap["ego_id"] for gap in drive["not_judged"] if gap["reason_code"] in MAP_MISFIT_CODES})


def _log_note(drives: Sequence[Row]) -> InputNote:
    """Return the note on whether the logs are complete: losses, assumptions, the number of warnings, and logs with the same bytes."""
    lossy = [drive["drive_id"] for drive in drives if drive["lossy"]]
    checks = [check for drive in drives for check in drive["quality"] if check["check_id"] != ASIDE_OF_LANE_CHECK]
    assumed = sorted(
        {check["message"].partition(";")[0] for check in checks if check["check_id"] == ASSUMED_MOTION_CHECK}
    )
    assumptions = sorted({check["message"] for check in checks if check["check_id"] in _ASSUMPTION_CHECKS})
    warned = {(check["check_id"], check["message"]) for check in checks if check["severity"] != "info"}
    parts = [f"parts lost in {name_list(lossy, _MAX_LISTED_NAMES)}"] if lossy else []
    absent = [(drive["drive_id"], words) for drive in drives for words in ego_absence_texts(drive)]
    parts += (
        [name_list([f"{name}: {words}" if len(drives) > 1 else words for name, words in absent], _MAX_LISTED_NAMES)]
        if absent
        else []
    )
    parts += assumed
    if not parts:
        parts = [_completeness_words(drives)] if drives else ["none"]
    parts += assumptions
    if warned:
        names = sorted({check.replace("_", " ") for check, _ in warned})
        parts.append(
            f"{plural(len(warned), 'warning')} ({name_list(names, _MAX_LISTED_NAMES)}){_first_place_words(warned)}"
        )
    parts += (copied := _words_on_identical_logs(drives))
    return InputNote("log", "; ".join(parts), is_warning=bool(lossy or assumed or warned or copied))


def _first_place_words(warned: AbstractSet[tuple[str, str]]) -> str:
    """Return the message of the gravest warning about rows of a file, and where the other warnings are; '' for none."""
    placed_warnings = sorted(((_PLACED_CHECKS.index(check), text) for check, text in warned if check in _PLACED_CHECKS))
    if not placed_warnings:
        return ""
    more = "; drivelint inspect shows the others" if len(warned) > 1 else ""
    return f": {placed_warnings[0][1]}{more}"


def _completeness_words(drives: Sequence[Row]) -> str:
    """Return in words that the logs are complete, as far as their formats show it."""
    names = [drive["file_name"].lower() for drive in drives]
    without = [end for end in _SUFFIXES_WITHOUT_END_MARKER if any(name.endswith(end) for name in names)]
    return f"complete, as far as the format {name_list(without)} shows it" if without else "complete"


def _words_on_identical_logs(drives: Sequence[Row]) -> list[str]:
    """Return in words which logs are copies of another log under another name; the findings of copies are counted too."""
    same = counts.group_rows(drives, lambda drive: drive["sha256"]).values()
    copied = [(name["drive_id"], first["drive_id"]) for first, *copies in same for name in copies]
    if not copied:
        return []
    texts = [f"{copy} of {first}" for copy, first in sorted(copied)]
    return [f"{'a copy' if len(texts) == 1 else 'copies'}, counted again: {name_list(texts, _MAX_LISTED_NAMES)}"]


def _notes_on_unrecorded_signals(result: Result) -> list[InputNote]:
    """Return the note on signals that few logs contain and these logs lack, with the number of rules that need them."""
    rows = counts.verdicts_lacking_signal(result.verdicts).select(["reason_code", "rule_id", *_EGO_COLUMNS]).to_pylist()
    signals = [
        f"{name} (needed by {plural(n, 'rule')}{', ' if where else ''}{where})"
        for name, n, where in _lacking_signals(result, rows)
    ]
    return [InputNote("not recorded", name_list(signals), is_warning=True)] if rows else []


def _notes_on_parked_egos(result: Result) -> list[InputNote]:
    """Return the note on egos that never move (in perception logs, two thirds of the egos).

    Only rules about standing vehicles apply to them.
    """
    parked = result.verdicts.filter(pc.equal(result.verdicts["reason_code"], _NEVER_MOVES_CODE))
    n, of = (len(counts.distinct_rows(verdicts, _EGO_COLUMNS)) for verdicts in (parked, result.verdicts))
    words = f"{n} of {plural(of, 'ego')} never move{'s' if n == 1 else ''}: only rules about standing vehicles apply"
    return [InputNote("parked", words, is_warning=False)] if n else []


def _lacking_signals(result: Result, rows: Sequence[Row]) -> list[tuple[str, int, str]]:
    """Return the signals that verdicts lack, the signal that most rules need first: name, number of rules, and for which egos."""
    rows_by_signal = counts.group_rows(rows, lambda row: signal_name(row["reason_code"]))
    order = sorted(rows_by_signal.items(), key=lambda item: (-n_rules(item[1]), -len(item[1]), item[0]))
    egos = {(row["drive_id"], row["ego_id"]) for row in counts.distinct_rows(result.verdicts, _EGO_COLUMNS)}
    return [(name, n_rules(verdicts), _for_egos_words(verdicts, egos)) for name, verdicts in order]


def _not_judged_note(result: Result, n_drives: int) -> InputNote:
    """Return the note on what was not judged: drives, rules by the missing signal, and the number of other undecided verdicts."""
    tables = [counts.undecided_verdicts(result.verdicts), gating_verdicts_lacking_signal(result)]
    rows = pa.concat_tables(tables).select(["reason_code", "rule_id", *_EGO_COLUMNS]).to_pylist()
    signals = [row for row in rows if row["reason_code"].startswith((MISSING_PREFIX, UNRECORDED_PREFIX))]
    parts = [plural(n_drives, "drive")] if n_drives else []
    if signals:
        without = [
            f"{plural(n, 'rule')} without {name}{_REMEDY_BY_SIGNAL.get(name, '')}{f' ({where})' if where else ''}"
            for name, n, where in _lacking_signals(result, signals)
        ]
        parts.append(name_list(without))
    if n_others := len(rows) - len(signals):
        parts.append(f"{n_others} {'other ' if signals else ''}{'verdict' if n_others == 1 else 'verdicts'}")
    return InputNote("not judged", "; ".join(parts) or "nothing", is_warning=bool(parts))


def _for_egos_words(rows: Iterable[Row], egos: AbstractSet[tuple[str, str]]) -> str:
    """Return in words how many egos these verdicts are about, or how many drives if each has one ego; '' if they are about all."""
    n = len({(row["drive_id"], row["ego_id"]) for row in rows})
    noun = "ego" if len(egos) > len({drive_id for drive_id, _ in egos}) else "drive"
    return "" if n == len(egos) else f"for {n} of {plural(len(egos), noun)}"


def n_rules_without_map(result: Result) -> int:
    """Return the number of rules with an unknown verdict because no map was given; 0 if any drive has a map."""
    on_map = pc.is_valid(result.drives["map_name"])
    if pc.any(on_map).as_py():
        return 0
    undecided = counts.undecided_verdicts(result.verdicts)
    return len(pc.unique(undecided.filter(pc.equal(undecided["reason_code"], _NO_MAP_CODE))["rule_id"]))


def undecided_verdicts_by_cause(result: Result) -> list[list[Row]]:
    """Return the undecided verdicts, except those of missing signals, in a group per cause; the most frequent cause first.

    A group begins with its shortest reason; a verdict whose reason ends with another's reason joins its group.
    """
    columns = ["verdict", "reason_code", "cause_code", "rule_id", "drive_id", "reason"]
    rows = counts.undecided_verdicts(result.verdicts).select(columns).to_pylist()
    other_rows = [row for row in rows if not row["reason_code"].startswith("missing_")]
    by_code = counts.group_rows(other_rows, lambda row: (row["verdict"], row["reason_code"], row["cause_code"] or ""))
    groups: dict[tuple[str, str], list[Row]] = {}
    for group in sorted(by_code.values(), key=lambda group: len(group[0]["reason"])):
        verdict, text = group[0]["verdict"], group[0]["reason"].rstrip(".").casefold()
        same = next(
            (key for key in groups if key[0] == verdict and f": {text}".endswith(f": {key[1]}")), (verdict, text)
        )
        groups.setdefault(same, []).extend(group)
    return sorted(groups.values(), key=lambda group: (-n_rules(group), -len(group), group[0]["reason_code"]))


def n_rules(verdicts: Iterable[Row]) -> int:
    """Return the number of rules of these verdicts."""
    return len({row["rule_id"] for row in verdicts})
