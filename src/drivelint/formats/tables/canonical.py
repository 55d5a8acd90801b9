"""Reads canonical Parquet: a folder with tables of `schemas/model.sql` as files, or a single file with `actor_state`.

Positions are box centres, as in the tables.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import msgspec
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import codes_of_texts, words_of_codes
from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import (
    ACTOR_CLASSES,
    BRAKE_LIGHTS,
    CHECKS_REPEATED_AT_READING,
    INDICATORS,
    SIGNAL_STATES,
    SIZE_COLUMNS,
    STATE_COLUMNS,
    QualityFinding,
    Recording,
    States,
)
from drivelint.errors import TraceError
from drivelint.formats.folders import is_canonical_folder
from drivelint.formats.osi.metadata import parse_conditions, validated_findings
from drivelint.formats.tables import parquet
from drivelint.sql.store import arrow_schemas
from drivelint.sql.words import nearest_word_hint

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from drivelint.arrays import Codes, Mask
    from drivelint.drive.trace import Trace
    from drivelint.formats.probe import Probe

formats: Final = {"canonical-parquet": ("drivelint's own Parquet tables", "marked is_ego in the log")}
takes_mapping: Final = False
AS_RECORDED_KEY: Final = "drivelint.as_recorded"
"""Key in the metadata of a converted log's tables, if its states are as recorded, without corrections or derived values."""
REQUIRED_COLUMNS = ("t_ns", "actor_id", "x_m", "y_m", "yaw_rad")
"""A Parquet table with these columns is canonical. Any other column may be missing, and is then unknown."""
_WORDS_OF_STATE_COLUMN = {"indicator": INDICATORS, "brake_light": BRAKE_LIGHTS, "actor_class": ACTOR_CLASSES}
_WORDS_OF_COLUMN = {**_WORDS_OF_STATE_COLUMN, "state": SIGNAL_STATES}
"""Column -> its allowed words, in which upper and lower case do not matter."""


def accepts(probe: Probe) -> bool:
    """Return whether the trace is a canonical folder, or Parquet with canonical columns and without a chosen mapping."""
    if probe.path.is_dir():
        return is_canonical_folder(probe.path)
    if probe.options.mapping is not None or not probe.head.startswith(b"PAR1"):
        return False
    return set(REQUIRED_COLUMNS) <= set(parquet.schema(probe.path).names)


def read(probe: Probe) -> Recording:
    """Read a canonical folder or file.

    Errors: `TraceError` for damaged files, missing columns, columns of a wrong type, and several drives in one file.
    """
    path = probe.path
    recording = _read_states(path / "actor_state.parquet" if path.is_dir() else path)
    states, findings = recording.states, recording.findings
    if not path.is_dir():
        return recording
    recording.actors = _read_table_if_present(
        path / "actor.parquet", ("actor_id",), (*SIZE_COLUMNS, "actor_class", "is_ego")
    )
    if recording.actors is not None:
        recording.ego_ids += [
            row["actor_id"]
            for row in _dict_rows(path / "actor.parquet", recording.actors)
            if row.get("is_ego") and row["actor_id"]
        ]
    recording.signals = _read_table_refusing_nulls(path / "signal_state.parquet", ("signal_id", "t_ns"), "state")
    recording.events = _read_table_refusing_nulls(
        path / "declared_event.parquet", ("actor_id", "t_ns", "event"), "value"
    )
    conditions = path / "drive_condition.parquet"
    if condition_rows := _read_table_if_present(conditions, ("condition", "value")):
        recording.conditions = parse_conditions(conditions, zip(*condition_rows.to_pydict().values(), strict=True))
    if (path / "data_log.parquet").is_file():
        log = (_dict_rows(path / "data_log.parquet", parquet.table(path / "data_log.parquet")) or [{}])[0]
        n_stated, n_read = log.get("n_states"), len(states) + sum(f.n for f in findings if f.check_id == "dropped_row")
        if n_stated is not None and n_stated != n_read:  # it is unknown which states are missing
            raise TraceError(
                f"{path / 'actor_state.parquet'}: {n_read} rows, but data_log.parquet states {n_stated}: copy or "
                "convert the folder again"
            )
        recording.sensor_range_m, recording.utc_start_ns = log.get("sensor_range_m"), log.get("utc_start_ns")
        offset = log.get("map_offset_x_m"), log.get("map_offset_y_m")
        if offset != (None, None):
            dx, dy = recording.map_offset = _valid_map_offset(path, offset)
            recording.notes.append(f"the log moves the map by ({dx:+g}, {dy:+g}) m")
        if geo := _read_table_if_present(
            path / "data_log.parquet", (), ("geo_reference", "geo_x_m", "geo_y_m", "geo_yaw_rad")
        ):
            (geo_row, *_) = _dict_rows(path / "data_log.parquet", geo)
            x, y, yaw = (geo_row.get(name) or 0.0 for name in ("geo_x_m", "geo_y_m", "geo_yaw_rad"))
            recording.geo_reference, recording.geo_offset = geo_row.get("geo_reference"), (x, y, yaw)
    if (path / "map.xodr").is_file():
        recording.embedded_map = (path / "map.xodr").read_bytes()
    recording.findings += _findings_before_conversion(path / "quality.parquet")
    return recording


def _valid_map_offset(path: Path, offset: tuple[object, object]) -> tuple[float, float]:
    match offset:
        case (float(x), float(y)) if np.isfinite([x, y]).all():
            return x, y
    raise TraceError(f"{path / 'data_log.parquet'}: map_offset_x_m and map_offset_y_m are {offset}: give two numbers")


def _findings_before_conversion(path: Path) -> list[QualityFinding]:
    """Return the findings from before the conversion, without those that are found again in the converted log."""
    if not path.is_file():
        return []
    rows = parquet.table(path)
    _require_columns_and_one_drive(path, rows, ("check_id", "severity", "message"))
    again = CHECKS_REPEATED_AT_READING if AS_RECORDED_KEY.encode() in (rows.schema.metadata or {}) else ()
    try:
        findings = [msgspec.convert(row, QualityFinding) for row in _dict_rows(path, rows)]
        return validated_findings(path, [finding for finding in findings if finding.check_id not in again])
    except msgspec.ValidationError as error:
        raise TraceError(f"{path}: not rows of the table quality: {error}") from error


def _typed_column(path: Path, table: pa.Table, name: str, kind: pa.DataType) -> pa.Array:
    column = parquet.column(table, name)
    try:
        return column.cast(kind)
    except pa.ArrowException as error:
        raise TraceError(
            f"{path}: column {name!r} is {column.type}, not {kind}: {' '.join(str(error).split())}"
        ) from error


def _typed_columns(path: Path, table: pa.Table, names: Iterable[str], kind: pa.DataType) -> dict[str, pa.Array]:
    """Return name -> column, cast to `kind`, for the names that the table has."""
    return {name: _typed_column(path, table, name, kind) for name in names if name in table.schema.names}


def _require_columns_and_one_drive(path: Path, table: pa.Table, names: tuple[str, ...]) -> None:
    lacking = [name for name in names if name not in table.schema.names]
    if lacking:
        raise TraceError(f"{path}: no column {', '.join(lacking)}: a canonical table needs {', '.join(names)}")
    drives = pc.unique(_typed_column(path, table, "drive_id", pa.string())) if "drive_id" in table.schema.names else []
    if len(drives) > 1:
        raise TraceError(f"{path}: contains {len(drives)} drives: write one folder or file per drive")


def _read_states(path: Path) -> Recording:
    """Read the states. A row with only a time is a frame without actors."""
    table = parquet.table(path)
    _require_columns_and_one_drive(path, table, REQUIRED_COLUMNS)
    ids = _typed_column(path, table, "actor_id", pa.string())
    times = _typed_column(path, table, "t_ns", pa.int64())
    timed = times.is_valid().to_numpy(zero_copy_only=False)
    nameless = pc.equal(pc.fill_null(ids, ""), "").to_numpy(zero_copy_only=False)
    n = len(ids)
    is_empty_frame = nameless & timed & _has_no_actor_values(table, n) if nameless.any() else nameless
    lost_rows = (nameless | ~timed) & ~is_empty_frame
    numbers, not_finite = {}, np.zeros(n, np.bool_)
    for name, column in _typed_columns(path, table, (*STATE_COLUMNS, *SIZE_COLUMNS), pa.float64()).items():
        values = pc.fill_null(column, float("nan")).to_numpy(zero_copy_only=False)
        odd = ~np.isfinite(values)
        numbers[name] = np.where(odd, np.nan, values)
        not_finite |= odd & column.is_valid().to_numpy(zero_copy_only=False)
    texts = _typed_columns(path, table, _WORDS_OF_STATE_COLUMN, pa.string())
    codes = {name: _word_codes(path, column, name) for name, column in texts.items()}
    egos: list[str] = []
    for column in _typed_columns(path, table, ("is_ego",), pa.bool_()).values():
        is_ego = pc.fill_null(column, fill_value=False)
        egos = [i for i in pc.unique(ids.filter(is_ego)).to_pylist() if i]
    encoded = pc.dictionary_encode(pc.fill_null(ids, ""))
    actor = encoded.indices.to_numpy()
    t_ns = pc.fill_null(times, 0).to_numpy(zero_copy_only=False)
    states = States(encoded.dictionary.to_pylist(), actor, t_ns, numbers, codes, not_finite)
    recording = Recording("canonical-parquet", states, ego_ids=egos)
    if is_empty_frame.any():
        recording.frames_ns = t_ns[timed]
    if is_empty_frame.any() or lost_rows.any():
        recording.states = states.take(~(lost_rows | is_empty_frame))
    if lost_rows.any():
        description, n_lost = f"{path.name}: rows without actor or time", int(lost_rows.sum())
        recording.findings = [
            QualityFinding("dropped_row", "error", f"{description}: {n_lost}: they are not judged", n_lost)
        ]
        recording.lost_times = times_of_lost_rows(t_ns, timed, lost_rows, description)
    return recording


def with_rows_of_times_without_actors(states: pa.Table, trace: Trace) -> pa.Table:
    """Return the states with an added row, which has only a time, for each frame without actors."""
    n = len(trace.times_without_actors_ns)
    if not n:
        return states
    empty = {field.name: pa.nulls(n, field.type) for field in states.schema}
    empty |= {"drive_id": pa.array([trace.drive_id] * n, pa.string()), "t_ns": pa.array(trace.times_without_actors_ns)}
    return pa.concat_tables([states, pa.table(empty, schema=states.schema)])


def _has_no_actor_values(table: pa.Table, n_rows: int) -> Mask:
    """Return for each row whether all columns on actors are NULL."""
    columns = set(table.schema.names) & {*STATE_COLUMNS, *SIZE_COLUMNS, *_WORDS_OF_STATE_COLUMN, "is_ego"}
    empty = [table[name].is_null().to_numpy() for name in sorted(columns)]
    is_empty: Mask = np.logical_and.reduce([np.ones(n_rows, np.bool_), *empty])
    return is_empty


def _word_codes(path: Path, column: pa.Array, name: str) -> Codes:
    words = _WORDS_OF_COLUMN[name]

    def code_of(word: str) -> int:
        if word.casefold() not in words:
            raise TraceError(f"{path}: {name} is {word!r}; {nearest_word_hint(word, words)} (NULL: unknown)")
        return words.index(word.casefold())

    return codes_of_texts(column, code_of)


def _dict_rows(path: Path, table: pa.Table) -> list[dict[str, Any]]:
    """Return the rows of a table. Errors: `TraceError` for a value that Python does not have, such as a date after the year 9999."""
    try:
        rows: list[dict[str, Any]] = table.to_pylist()
    except (OverflowError, ValueError, pa.ArrowException) as error:
        raise TraceError(f"{path}: a value cannot be read ({error}): write the table again") from error
    return rows


def _read_table_if_present(path: Path, required: tuple[str, ...], optional: tuple[str, ...] = ()) -> pa.Table | None:
    """Return the required columns of a file and its available optional columns; None if there is no such file."""
    if not path.is_file():
        return None
    table = parquet.table(path)
    _require_columns_and_one_drive(path, table, required)
    columns = {}
    for field in (arrow_schemas()[path.stem].field(name) for name in (*required, *optional)):
        if field.name in table.schema.names:
            column = _typed_column(path, table, field.name, field.type)
            words = _WORDS_OF_COLUMN.get(field.name)
            columns[field.name] = (
                column if words is None else words_of_codes(_word_codes(path, column, field.name), words)
            )
    return pa.table(columns)


def _read_table_refusing_nulls(path: Path, required: tuple[str, ...], optional: str) -> pa.Table | None:
    """Return required columns and an optional text column, which is NULL if the file lacks it; None if there is no such file.

    Errors: `TraceError` for NULL in a required column.
    """
    table = _read_table_if_present(path, required, (optional,))
    if table is None:
        return None
    for name in required:
        if table[name].null_count:
            raise TraceError(f"{path}: {table[name].null_count} rows have no {name}: fill this column in every row")
    return table if optional in table.schema.names else table.append_column(optional, pa.nulls(len(table), pa.string()))
