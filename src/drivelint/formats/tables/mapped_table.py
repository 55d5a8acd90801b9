"""Reads CSV and Parquet tables through a mapping: long tables (a row per actor and step) or wide tables (a column group per actor).

The mapping states the reference point of the positions (`[reference]`): the box centre, the rear axle or the front bumper. `geometry`
converts the positions to box centres.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import codes_of_texts
from drivelint.drive.clock_restart import rows_back_in_time
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import (
    ACTOR_CLASSES,
    ASSUMED_SIZE_CHECK,
    LOSS_CHECKS,
    MOTOR_VEHICLES,
    TURNED_FRAME_CHECK,
    LostTime,
    QualityFinding,
    Recording,
    States,
)
from drivelint.errors import TraceError
from drivelint.formats.tables import mapping as mappings
from drivelint.formats.tables.geometry import convert_to_map_frame
from drivelint.formats.tables.mapping import FIELD_QUANTITIES, GROUP_PLACEHOLDER, UNITS
from drivelint.formats.tables.sheets import CsvSheet, ParquetSheet, Sheet, describe_places
from drivelint.phrases import name_list, nearest_word

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.arrays import Codes, Floats, Indices, Mask, Times
    from drivelint.formats.probe import Probe
    from drivelint.formats.tables.mapping import Field, Mapping, WordMapping

formats: Final[dict[str, tuple[str, str]]] = {}
takes_mapping: Final = True
_UNKNOWN_CLASS_CODES: Final = frozenset({-1, ACTOR_CLASSES.index("vehicle")})
"""The codes for an unknown class, and for a vehicle of unknown class."""
_MOST_LISTED_TEXTS: Final = 5
"""A message lists at most this many texts."""
MAX_HEADING_RAD: Final = 4 * np.pi
"""The largest plausible heading: without wrapping, it exceeds one turn on roundabouts and ramps of car parks."""


def accepts(probe: Probe) -> bool:
    """Return whether the file is Parquet, or text that is neither XML nor JSON."""
    head = probe.head
    content = head.rstrip(b"\0")  # a file that was not written to its end may end in zero bytes
    text = content if content.count(b"\n") > 1 else head
    return head.startswith(b"PAR1") or not (b"\0" in text or text.lstrip()[:1] in {b"<", b"{"})


def read(probe: Probe) -> Recording:
    """Read a table through the mapping that the user chose, otherwise through the only shipped mapping whose columns the table has.

    Errors: `UsageError` for an invalid mapping; `TraceError` for a table that does not fit the mapping or cannot be read.
    """
    path, name = probe.path, probe.options.mapping
    if name is None:
        name, mapping, sheet = _fitting_mapping_and_sheet(path)
        notes = [
            f"read through the shipped mapping {name!r}, the only shipped mapping that matches the columns of the file"
        ]
    else:
        name, mapping = mappings.load(name)
        sheet = open_sheet(path, mapping)
        notes = []
    recording = read_sheet(path, name, mapping, sheet)
    recording.notes = notes + recording.notes
    return recording


def read_sheet(path: Path, name: str, mapping: Mapping, sheet: Sheet) -> Recording:
    """Read a table through a mapping. Errors: `TraceError` for a table that does not fit the mapping."""
    recording = _MappedTable(path, mapping, sheet, _column_group_numbers(path, name, mapping, sheet)).read()
    _refuse_if_most_rows_unread(path, name, recording)
    recording.format = name
    recording.findings += _assumption_findings(name, mapping)
    if mapping.frame.map_offset_m is not None:
        dx, dy = recording.map_offset = mapping.frame.map_offset_m
        recording.notes.append(f"mapping {name!r} moves the map by ({dx:+g}, {dy:+g}) m")
    return recording


def _assumption_findings(name: str, mapping: Mapping) -> list[QualityFinding]:
    """Return findings on facts that come from the mapping, not from the log: sizes, and a left-handed frame."""
    findings = []
    fields_of_mapping = mappings.fields(mapping)
    if any(side in fields_of_mapping and fields_of_mapping[side].value is not None for side in ("length", "width")):
        findings.append(QualityFinding(ASSUMED_SIZE_CHECK, "info", f"size from the mapping {name!r}, not recorded"))
    turns = {"y": mapping.frame.flip_y, "heading": mapping.frame.flip_yaw}
    if turned := [statement for statement, is_turned in turns.items() if is_turned]:
        message = f"{' and '.join(turned)} changed in sign, because the frame of the log is left-handed according to the mapping {name!r}"
        findings.append(QualityFinding(TURNED_FRAME_CHECK, "info", message))
    return findings


def _refuse_if_most_rows_unread(path: Path, name: str, recording: Recording) -> None:
    """Raise `TraceError` if most rows cannot be read: the mapping is wrong, and the other rows would mislead."""
    n_lost = sum(finding.n for finding in recording.findings if finding.check_id in LOSS_CHECKS)
    n_kept = len(recording.states)
    if n_lost > n_kept > 0:
        why = next(finding.message for finding in recording.findings if finding.check_id in LOSS_CHECKS)
        raise TraceError(
            f"{path}: mapping {name!r} cannot read {n_lost} of {n_lost + n_kept} rows ({why}): give the right mapping with --mapping"
        )


def open_sheet(path: Path, mapping: Mapping) -> Sheet:
    """Return a Parquet table, or a CSV table with the mapping's layout, without reading rows. Errors: `TraceError` if it is invalid."""
    with path.open("rb") as file:
        is_parquet = file.read(4) == b"PAR1"
    return ParquetSheet(path) if is_parquet else CsvSheet(path, mapping.table)


def _fitting_mapping_and_sheet(path: Path) -> tuple[str, Mapping, Sheet]:
    fits = []
    for name in mappings.shipped_mappings():
        _, mapping = mappings.load(name)
        try:
            sheet = open_sheet(path, mapping)
            _column_group_numbers(path, name, mapping, sheet)
        except TraceError:
            continue  # the mapping does not fit; an error is raised below if no mapping fits
        fits.append((name, mapping, sheet))
    if len(fits) == 1:
        return fits[0]
    problem = f"several mappings fit ({', '.join(name for name, _, _ in fits)})"
    if not fits:
        shipped = ", ".join(mappings.shipped_mappings())
        problem = f"read as a table, no shipped mapping fits its columns (shipped: {shipped})"
    raise TraceError(f"{path}: {problem}: give a mapping with --mapping FILE|NAME; drivelint inspect drafts one")


def _column_group_numbers(path: Path, name: str, mapping: Mapping, sheet: Sheet) -> list[str]:
    """Return the numbers of the column groups; only '' for a long table.

    Errors: `TraceError` for a needed column that is missing or duplicate.
    """
    columns = mappings.needed_columns(mapping)
    templates = [column for column in columns if GROUP_PLACEHOLDER in column]
    groups = [""]
    if templates:
        shape = re.compile(re.escape(templates[0]).replace(re.escape(GROUP_PLACEHOLDER), r"(\d+)"))
        groups = sorted({match[1] for column in sheet.names if (match := shape.fullmatch(column))}, key=int) or ["1"]
    needed_columns = [column.replace(GROUP_PLACEHOLDER, k) for column in columns for k in groups]
    for column in needed_columns:
        count = sheet.names.count(column)
        if count == 0:
            near = nearest_word(column, [unused for unused in sheet.names if unused not in needed_columns])
            suggestion = f"did you mean {near!r}?" if near else f"known are {', '.join(sheet.names)}"
            raise TraceError(f"{path}: no column {column!r}, which mapping {name!r} needs: {suggestion}")
        if count > 1:
            raise TraceError(f"{path}: the column {column!r} occurs {count} times: rename all but one")
    return groups


@dataclass
class _MappedTable:
    """The rows of a table that fits its mapping."""

    path: Path
    mapping: Mapping
    sheet: Sheet
    groups: list[str]
    findings: list[QualityFinding] = field(default_factory=list)
    unmapped_classes: set[str] = field(default_factory=set)
    """The texts in the class column that match neither values nor patterns of the mapping."""

    def read(self) -> Recording:
        columns = mappings.needed_columns(self.mapping)
        names = dict.fromkeys(column.replace(GROUP_PLACEHOLDER, group) for group in self.groups for column in columns)
        n_rows = self.sheet.load(names)
        t_ns, bad_time = self.sheet.times_and_bad(self.mapping.time.column, self.mapping.time.unit_ns)
        blank = np.ones(n_rows, np.bool_)  # the rows whose mapped columns are all empty
        for name in names:
            blank &= ~self.sheet.is_filled(name)
        self._report_rows(bad_time & ~blank, "the time is missing or not a number", "dropped_row")
        self._report_malformed_lines(n_rows)
        parts, texts, row_numbers = [], [], []
        lost_rows = bad_time & ~blank
        for group in self.groups:
            ids = self._actor_ids(group, n_rows)
            absent = ids.is_null().to_numpy(zero_copy_only=False)
            # in a wide table, an actor without name and place is absent
            nameless = absent & ~bad_time & ~blank & (True if group == "" else self._has_position(group, n_rows))
            self._report_rows(nameless, "the actor id is missing", "dropped_row")
            lost_rows |= nameless
            keep = ~(absent | bad_time)
            texts.append(ids.filter(pa.array(keep)))
            parts.append(self._states_of_group(group, n_rows, t_ns, keep))
            row_numbers.append(np.flatnonzero(keep))
        ids = pc.dictionary_encode(pa.concat_arrays(texts))
        states = States.concatenate(parts)
        states.ids, states.actor = ids.dictionary.to_pylist(), ids.indices.to_numpy()
        self._report_rows_back_in_time(states, np.concatenate(row_numbers))
        convert_to_map_frame(states, self.mapping)
        self._report_if_no_class_is_mapped(states)
        return Recording(
            format="",
            states=states,
            ego_ids=self._ego_ids(states),
            findings=self.findings,
            lost_times=self._lost_times(t_ns, ~bad_time, lost_rows),
            # each row of a wide table is a frame, also without actors
            frames_ns=t_ns[~bad_time] if self.groups != [""] else None,
            embedded_map=self.sheet.metadata.get(b"xodr"),
            strict_units=True,
            names_indicator=self.mapping.indicator is not None,
        )

    def _has_position(self, group: str, n_rows: int) -> Mask:
        has_position = np.ones(n_rows, np.bool_)
        for name in ("x", "y"):
            column = mappings.fields(self.mapping)[name].column
            if column is not None:
                has_position &= self.sheet.is_filled(column.replace(GROUP_PLACEHOLDER, group))
        return has_position

    def _lost_times(self, t_ns: Times, timed: Mask, lost_rows: Mask) -> list[LostTime]:
        """Return the time ranges of lost rows and of malformed lines, whose times are unknown."""
        cause = f"{self.path.name}: rows that cannot be read"
        if self.sheet.has_content_after_zeros:
            return [LostTime(None, None, f"{cause}, because the file contains zero bytes there")]
        places = self.sheet.row_counts_before_bad_lines() + [len(t_ns)] * (self.sheet.zeros_at is not None)
        t_ns, timed, lost_rows = (
            np.insert(t_ns, places, 0),
            np.insert(timed, places, False),
            np.insert(lost_rows, places, True),
        )
        return times_of_lost_rows(t_ns, timed, lost_rows, cause)

    def _states_of_group(self, group: str, n_rows: int, t_ns: Times, keep: Mask) -> States:
        numbers, not_finite = {}, np.zeros(n_rows, np.bool_)
        for name, spec in mappings.fields(self.mapping).items():
            if name in FIELD_QUANTITIES:
                values, odd = self._si_values_and_non_finite(name, spec, group, n_rows, keep)
                not_finite |= odd
                numbers[name] = values[keep]
        codes = {
            name: self._word_codes(spec, allowed_words, group, n_rows)[keep]
            for name, (spec, allowed_words) in mappings.word_mappings(self.mapping).items()
        }
        return States([], np.zeros(0, np.int32), t_ns[keep], numbers, codes, not_finite[keep])

    def _si_values_and_non_finite(
        self, name: str, spec: Field, group: str, n_rows: int, keep: Mask
    ) -> tuple[Floats, Mask]:
        """Return SI values (NaN: unknown), and for each row whether the log contains NaN or infinity; an empty cell does not count."""
        units = UNITS[FIELD_QUANTITIES[name]]
        factor = units[spec.unit] if spec.unit is not None else 1.0
        if spec.column is None:
            return np.full(n_rows, float(spec.value or 0.0) * factor), np.zeros(n_rows, np.bool_)
        column = spec.column.replace(GROUP_PLACEHOLDER, group)
        values, bad = self.sheet.numbers_and_bad(column)
        self._report_rows(bad & keep, f"column {column!r} is not a number", "malformed_cell")
        odd = ~np.isfinite(values)
        if odd.any():
            values = np.where(odd, np.nan, values)
            odd &= self.sheet.is_filled(column) & ~bad
        if FIELD_QUANTITIES[name] == "angle" and factor == 1.0:
            self._refuse_degrees(column, values)
        return (values * factor if factor != 1.0 else values), odd

    def _refuse_degrees(self, column: str, values: Floats) -> None:
        """Raise `TraceError` if a heading in radians exceeds two turns: it is probably in degrees."""
        largest = float(np.nanmax(np.abs(values), initial=0.0))
        if largest > MAX_HEADING_RAD:
            raise TraceError(
                f"{self.path}: column {column!r} goes up to {largest:g}, which is not an angle in radians: "
                'give a mapping with --mapping in which the unit is "deg"; drivelint inspect drafts one'
            )

    def _word_codes(self, spec: WordMapping, words: tuple[str, ...], group: str, n: int) -> Codes:
        """Return the column's texts as indices in `words`; -1: unknown. Each distinct text is translated only once."""
        if not spec.columns:
            return np.full(n, -1 if spec.default is None else words.index(spec.default), np.int8)
        texts = [self.sheet.text_column(column.replace(GROUP_PLACEHOLDER, group)) for column in spec.columns]
        if len(texts) > 1:
            texts = [pc.binary_join_element_wise(*texts, "/", null_handling="emit_null")]

        def code_of(text: str) -> int:
            word = _mapped_word(text, spec)
            if spec is self.mapping.actor_class and not _is_mapped(text, spec):
                self.unmapped_classes.add(text)
            return -1 if word is None else words.index(word)

        return codes_of_texts(texts[0], code_of)

    def _actor_ids(self, group: str, n_rows: int) -> pa.Array:
        spec = mappings.to_field(self.mapping.columns.actor_id)
        if spec.column is None:
            value = spec.value if isinstance(spec.value, str) else f"{spec.value:g}"
            return pa.repeat(pa.scalar(value.replace(GROUP_PLACEHOLDER, group), pa.string()), n_rows)
        return self.sheet.text_column(spec.column.replace(GROUP_PLACEHOLDER, group))

    def _ego_ids(self, states: States) -> list[str]:
        for name in self.mapping.ego.ids:
            if name in states.ids:
                return [name]
        # omega-prime's Parquet has the ego in its metadata
        host = self.sheet.metadata.get(b"host_vehicle_idx", b"").decode("utf-8", "replace")
        if host in states.ids:
            return [host]
        if self.mapping.ego.otherwise is None or not len(states):
            return list(self.mapping.ego.ids)
        motor = np.array([kind in MOTOR_VEHICLES for kind in ACTOR_CLASSES] + [False], np.bool_)
        codes = states.codes.get("actor_class")
        rows = np.flatnonzero(motor[codes]) if codes is not None else np.arange(len(states))
        if not len(rows):
            return []
        first = states.ids[states.actor[rows[0]]]
        names = " or ".join(self.mapping.ego.ids)
        message = f"no actor has the name {names}: the first vehicle of the file, {first}, is used as the ego"
        self.findings.append(QualityFinding("ego_assumed", "info", message, actor_id=first))
        return [first]

    def _report_rows(self, rows: Mask, why: str, check: str) -> None:
        n = int(rows.sum())
        if n:
            follows = "not judged" if check == "dropped_row" else "those values are unknown"
            message = f"{self.path.name}, {self.sheet.describe_rows(np.flatnonzero(rows))}: {why}: {follows}"
            self.findings.append(QualityFinding(check, "warning" if check == "malformed_cell" else "error", message, n))

    def _report_rows_back_in_time(self, states: States, row_numbers: Indices) -> None:
        """Add a finding with the rows whose time is before that of the actor's previous row. `row_numbers`: the row of each state."""
        in_file = np.argsort(row_numbers, kind="stable")  # the states of a wide table follow each other by column group
        back = in_file[rows_back_in_time(states.t_ns[in_file], states.actor[in_file])]
        if len(back):
            rows = np.unique(row_numbers[back])
            message = (
                f"{self.path.name}, {self.sheet.describe_rows(rows)}: the time is before that of the actor's previous row: "
                "the rows are sorted by time"
            )
            self.findings.append(QualityFinding("clock_jump", "warning", message, len(rows), int(states.t_ns[back[0]])))

    def _report_if_no_class_is_mapped(self, states: States) -> None:
        """Add a finding with the unmapped texts of the class column, if the mapping finds no class for any actor."""
        spec, codes = self.mapping.actor_class, states.codes.get("actor_class")
        if (
            spec is None
            or codes is None
            or not self.unmapped_classes
            or not set(np.unique(codes)) <= _UNKNOWN_CLASS_CODES
        ):
            return
        texts = name_list([repr(text) for text in sorted(self.unmapped_classes)], _MOST_LISTED_TEXTS)
        are = "is" if len(self.unmapped_classes) == 1 else "are"
        message = f"column {'/'.join(spec.columns)}: {texts} {are} not in [class] values of the mapping"
        self.findings.append(QualityFinding("unmapped_class", "warning", message))

    def _report_malformed_lines(self, n_rows: int) -> None:
        if self.sheet.zeros_at is not None:
            message = f"{self.path.name}: zero bytes from byte {self.sheet.zeros_at} on: the original content is lost"
            self.findings.append(QualityFinding("malformed_row", "error", message))
        lines = self.sheet.bad_lines
        if not lines:
            return
        description = (
            f"{describe_places('line', lines, len(lines))}: the number of cells differs from the "
            f"{len(self.sheet.names)} cells of the header"
        )
        if n_rows == 0:
            raise TraceError(f"{self.path}: {description}: no row is left; check the mapping's separator and skip_rows")
        message = f"{self.path.name}, {description}: not judged"
        self.findings.append(QualityFinding("malformed_row", "error", message, len(lines)))


def _is_mapped(text: str, spec: WordMapping) -> bool:
    return text in spec.values or any(re.search(pattern.match, text) for pattern in spec.patterns)


def _mapped_word(text: str, spec: WordMapping) -> str | None:
    if text in spec.values:
        return spec.values[text]
    return next((pattern.word for pattern in spec.patterns if re.search(pattern.match, text)), spec.default)
