"""Converts a trace of any format to Parquet or to OSI in MCAP, which are read without a mapping."""

from __future__ import annotations

import os
import shlex
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

import pyarrow as pa

from drivelint.drive.finish import with_quality_finding
from drivelint.drive.time_span import cut_trace
from drivelint.drive.trace import DriveInput, QualityFinding
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import MapError, UsageError
from drivelint.formats import expand_traces, read_trace
from drivelint.formats.folders import CANONICAL_FILES, is_canonical_folder
from drivelint.formats.map_registry import root_element_name
from drivelint.formats.osi import writer as osi_log
from drivelint.formats.osi.metadata import CONVERTED_LOG_LIBRARY, ego_independent_quality
from drivelint.formats.tables import canonical, parquet
from drivelint.phrases import name_list, one_line
from drivelint.result.files import parquet_bytes_with_metadata
from drivelint.result.publishing import OutputError, ensure_writable_folder, publish
from drivelint.road.map_reader import MapSource

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.drive.trace import Trace

CONVERTED_TABLES: Final = ("actor", "actor_state", "data_log", "declared_event", "quality", "signal_state")
MAP_FILE: Final = "map.xodr"
CLIP_CHECK_ID: Final = "clip"
"""The data-quality check, information only, that names the log from which a clip was cut."""
_CONVERTED_KEY: Final = "drivelint.converted"
"""Key in the metadata of every Parquet file that is written."""
_MCAP_HEAD_BYTES: Final = 64
"""How many bytes of an MCAP file contain its magic bytes and its header, which names the program that wrote the file."""


class Clip(NamedTuple):
    """A named time range of a log, on the log's own clock."""

    name: str
    from_ns: int
    to_ns: int


@dataclass(frozen=True)
class ConvertRequest(DriveInput):
    """A request for `convert`; each field is named like its option."""

    trace: str
    to: Literal["mcap", "parquet"]
    out: Path
    clip: Clip | None = None
    """The part to convert; None: the whole log."""


@dataclass(frozen=True)
class ConvertedTrace:
    """The converted trace: its path, its files with their sizes, and counts."""

    path: Path
    bytes_by_file: dict[str, int]
    n_states: int
    n_actors: int
    map_name: str | None
    has_ego: bool
    notes: tuple[str, ...]
    check_options: tuple[str, ...] = ()
    """Options with which `check` judges the converted trace as the log was judged; empty: the defaults."""


def convert(request: ConvertRequest) -> ConvertedTrace:
    """Read a trace and write it into the folder `out`, as Parquet tables or as `<stem>.mcap`.

    The log's own map is copied unchanged; a note reports a map that cannot be copied or used.
    Errors: `TraceError` if the trace cannot be read; `UsageError` if another file would be overwritten or the format cannot
    store the given map; `MapError` if the given map cannot be read; `OutputError` if the folder cannot be written.
    """
    paths = expand_traces([request.trace])
    if len(paths) != 1:
        names = name_list([log.name for log in paths])
        raise UsageError(
            f"{request.trace}: {len(paths)} logs ({names}): convert takes one at a time, each with its own --out"
        )
    (path,) = paths
    stem = request.clip.name if request.clip else path.resolve().name if path.is_dir() else path.stem
    target = request.out / f"{stem}.mcap" if request.to == "mcap" else request.out
    _refuse_to_overwrite_others_files(path, request.out, target)
    # conditions that the user states and assumptions about unrecorded actors belong to a check, not to the log
    options = replace(request.ingest_options(need_ego=False), in_sight=False, conditions=())
    # values that need a whole log cannot be derived from a clip, so it stores the values of the log's judgement
    options = replace(options, as_recorded=request.clip is None)
    trace = read_trace(path, options)
    if request.clip is not None:
        finding = QualityFinding(CLIP_CHECK_ID, "info", _clip_source_sentence(trace, request.clip))
        trace = with_quality_finding(cut_trace(trace, request.clip.from_ns, request.clip.to_ns), finding)
    if request.map_offset is not None:
        x, y = request.map_offset
        trace = replace(_with_data_log_values(trace, map_offset_x_m=x, map_offset_y_m=y), map_offset=request.map_offset)
    road, trace, of_road = _map_to_write(request, trace)
    if trace.geo_reference is not None:
        x, y, yaw = trace.geo_offset
        trace = _with_data_log_values(trace, geo_reference=trace.geo_reference, geo_x_m=x, geo_y_m=y, geo_yaw_rad=yaw)
    ensure_writable_folder(request.out)
    write = _write_mcap_and_return_file_sizes if request.to == "mcap" else _write_parquet_and_return_file_sizes
    files = write(target, trace, road, as_recorded=options.as_recorded)
    notes = [*trace.notes, *of_road, *_notes_on_check_options(request)]
    has_ego = any(trace.tables["actor"]["is_ego"].to_pylist())
    if not has_ego:
        notes.append(
            "the log names no ego: choose one with --ego ID, here or in every check (drivelint inspect lists them)"
        )
    return ConvertedTrace(
        path=target,
        bytes_by_file=files,
        n_states=trace.tables["actor_state"].num_rows,
        n_actors=trace.tables["actor"].num_rows,
        map_name=None if road is None else road.name,
        has_ego=has_ego,
        notes=tuple(notes),
    )


def _clip_source_sentence(trace: Trace, clip: Clip) -> str:
    """Return the log and the time range that a clip is cut from, in one sentence."""
    (log,) = trace.tables["data_log"].to_pylist()
    from_s, to_s = ((t_ns - (log["t_start_ns"] or 0)) / 1e9 for t_ns in (clip.from_ns, clip.to_ns))
    whole = clip.from_ns <= (log["t_start_ns"] or 0) and clip.to_ns >= (log["t_end_ns"] or 0)
    return f"cut from {log['file_name']}, SHA-256 {log['sha256']}: {from_s:.2f} s to {to_s:.2f} s{', all of it' if whole else ' of it'}"


def _refuse_to_overwrite_others_files(source: Path, out: Path, target: Path) -> None:
    """Raise `UsageError`, which names the file, if a file that `convert` did not write would be overwritten."""
    if not out.exists():
        return
    if not out.is_dir():
        raise UsageError(f"--out {out} is a file: name a folder")
    targets = [out / name for name in CANONICAL_FILES] if target == out else [target]
    if out.samefile(source) or any(file.exists() and file.samefile(source) for file in targets):
        raise UsageError(f"--out {out}: that would overwrite the log itself: choose another folder")
    if target != out:
        if target.exists() and not _is_our_mcap(target):
            raise UsageError(f"{target} exists and was not written by convert: choose another --out")
    elif next(out.iterdir(), None) is not None and not (
        is_canonical_folder(out)
        and _CONVERTED_KEY.encode() in (parquet.schema(out / "actor_state.parquet").metadata or {})
    ):
        raise UsageError(f"--out {out} holds other files: a converted log is a folder of its own: choose another")


def _is_our_mcap(path: Path) -> bool:
    with path.open("rb") as file:
        return CONVERTED_LOG_LIBRARY.encode() in file.read(_MCAP_HEAD_BYTES)


def _notes_on_check_options(request: ConvertRequest) -> list[str]:
    """Return a note for each given option that a converted log cannot contain."""
    options = {name: getattr(request, name) for name in ("map_origin", "handedness", "visibility", "env")}
    unset = {field.name: field.default for field in fields(DriveInput)}
    names = ["--" + name.replace("_", "-") for name, value in options.items() if value != unset[name]]
    return [f"{name} is not part of the converted log: give it in every check" for name in names]


def _with_data_log_values(trace: Trace, **values: str | float) -> Trace:
    """Return the trace with these values in its row of `data_log`."""
    log = trace.tables["data_log"]
    for name, value in values.items():
        log = log.set_column(log.schema.get_field_index(name), name, pa.array([value]))
    return replace(trace, tables={**trace.tables, "data_log": log})


def _map_to_write(request: ConvertRequest, trace: Trace) -> tuple[MapSource | None, Trace, list[str]]:
    """Return the map to write (the user's, else the log's own), the trace in the map's frame, and notes. Errors: as `convert`."""
    library, embedded = MapLibrary(request), trace.embedded_map
    if library.uses_map_in_log(trace) or (road := library.find_source(trace)) is None:
        if embedded is None:
            return None, trace, list(library.doubts_on_map(trace, None).values())
        return _embedded_map_to_write(request, trace, MapSource(MAP_FILE, embedded))
    if request.to == "mcap" and (why := _why_unfit_for_mcap(road)):
        raise UsageError(why)
    # a wrong map is refused now, not when the converted log is checked
    return road, library.find(trace)[1], []


def _embedded_map_to_write(
    request: ConvertRequest, trace: Trace, road: MapSource
) -> tuple[MapSource | None, Trace, list[str]]:
    """Return the log's own map unchanged, the trace in the map's frame, and notes.

    A map that cannot be used is kept, too, since converting loses nothing. None as map: MCAP cannot store it.
    """
    notes = []
    library = MapLibrary(DriveInput())
    try:
        environment, trace = library.find(trace)
        library.doubts_on_map(trace, environment)
    except MapError as error:
        notes.append(f"the log's own map cannot be used: {error}")
    if request.to == "mcap" and (why := _why_unfit_for_mcap(road)):
        return None, trace, [*notes, f"the log's own map is left out: {why}"]
    return road, trace, notes


def _why_unfit_for_mcap(road: MapSource) -> str | None:
    """Return why a map cannot be stored in MCAP; None if it can."""
    if (root_element_name(road.content) or "").lower() != "opendrive":
        return "only an OpenDRIVE map can go along in MCAP (OSI has no message for another): use --to parquet"
    try:
        road.content.decode("utf-8")
    except UnicodeDecodeError as error:
        return (
            f"map {road.name} is not UTF-8 ({error.reason} at byte {error.start}), as OSI's texts are: save it as UTF-8, "
            "or use --to parquet"
        )
    return None


def _write_mcap_and_return_file_sizes(
    target: Path, trace: Trace, road: MapSource | None, *, as_recorded: bool
) -> dict[str, int]:
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        with temporary.open("wb") as file:
            osi_log.write_and_count_messages(file, trace, road, as_recorded=as_recorded)
        size = temporary.stat().st_size
        publish(target.parent, {}, {target.name: temporary})
    except OSError as error:
        raise OutputError(
            f"{target}: cannot be written: {error.strerror or error}; free the disk or choose another --out"
        ) from error
    finally:
        temporary.unlink(missing_ok=True)
    return {target.name: size}


def _write_parquet_and_return_file_sizes(
    target: Path, trace: Trace, road: MapSource | None, *, as_recorded: bool
) -> dict[str, int]:
    tables = {**trace.tables, "quality": ego_independent_quality(trace)}
    tables["actor_state"] = canonical.with_rows_of_times_without_actors(tables["actor_state"], trace)
    names = [*CONVERTED_TABLES, *(["drive_condition"] if tables["drive_condition"].num_rows else [])]
    about = {canonical.AS_RECORDED_KEY: "yes"} if as_recorded else {}
    contents = {
        f"{name}.parquet": parquet_bytes_with_metadata(tables[name], name, {_CONVERTED_KEY: name, **about})
        for name in names
    }
    if road is not None:
        contents[MAP_FILE] = road.content
    publish(target, contents, {name: None for name in CANONICAL_FILES if name not in contents})
    return {name: len(content) for name, content in contents.items()}


def summary_text(trace: ConvertedTrace) -> str:
    """Return a text of two lines: the written files, and the command that checks them."""
    size = sum(trace.bytes_by_file.values())
    amount = f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{max(size / 1e3, 0.1):.1f} kB"
    files = f"{len(trace.bytes_by_file)} files, " if len(trace.bytes_by_file) > 1 else ""
    road = f", the map {trace.map_name} with it" if trace.map_name else ", no map"
    ego = "" if trace.has_ego else " --ego ID"
    command = (
        f"drivelint check {shlex.quote(str(trace.path))}{ego}{'' if trace.map_name else ' --map MAP'}"
        f"{''.join(f' {shlex.quote(word)}' for word in trace.check_options)} --out results"
    )
    summary = f"{trace.path}: {files}{amount}, {trace.n_states} states of {trace.n_actors} actors{road}"
    return f"{one_line(summary)}\n{one_line(f'check it, without a mapping, with: {command}')}"
