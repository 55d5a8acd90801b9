"""Inspects a log without judging it: its content, its problems, and the rules that it can decide."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Final

import msgspec

from drivelint import catalogue
from drivelint.drive import conditions
from drivelint.drive.trace import OWN_MAP_UNUSABLE_CHECK, DriveInput
from drivelint.engine.batch import Drive as Judgeable
from drivelint.engine.batch import drive_with_map
from drivelint.engine.default_rules import packs_of_nation
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, MemoryLimit
from drivelint.engine.session import JudgingSession
from drivelint.errors import ExitCode, MapError, TraceError, UsageError
from drivelint.formats import expand_traces, read_trace
from drivelint.formats.registry import format_title_and_ego, may_be_mapped_table
from drivelint.formats.search import why_unreadable
from drivelint.inspect import advice, model, tracks
from drivelint.inspect.content import file_content, size_bytes
from drivelint.phrases import name_list
from drivelint.reasons import reason_text
from drivelint.sql import store
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    import duckdb

    from drivelint.catalogue import Rule
    from drivelint.drive.trace import IngestOptions, Trace
    from drivelint.road.map_reader import MapTables

_SEVERITIES: Final = ("error", "warning", "info")


@dataclass(frozen=True)
class InspectRequest(DriveInput):
    """The options of `inspect`, with the same names."""

    trace: str
    rules: tuple[str, ...] = ()
    rules_dirs: tuple[Path, ...] = ()
    memory: int | None = DEFAULT_MEMORY_BYTES
    """Memory of the database in bytes before it uses the disk; None: 80 % of the machine's memory."""


def inspect(request: InspectRequest) -> model.Inspection:
    """Return the inspection of a log; if the log cannot be read as a drive, `problem` states why.

    Errors: `TraceError` for a missing file, `UsageError`, `RuleError`, and `MapError` for an unreadable map. The result reports a map
    that does not cover the drive.
    """
    library, rules_by_id = MapLibrary(request), catalogue.load_rules(request.rules_dirs)
    selection = request.rules or packs_of_nation(rules_by_id, request, library)
    rules = catalogue.select_rules(rules_by_id, selection, ())
    paths = expand_traces([request.trace])
    if len(paths) != 1:
        raise UsageError(
            f"{request.trace}: {len(paths)} logs ({name_list([path.name for path in paths])}): inspect looks at one at a time"
        )
    (path,) = paths
    options = request.ingest_options(need_ego=False)
    name, size = path.resolve().name, 0 if why_unreadable(path) else size_bytes(path)
    try:
        trace = read_trace(path, options)
    except TraceError as error:
        unread = model.File(name=name, bytes=size)
        return model.Inspection(file=unread, content=_content_of_unread_log(path, options), problem=str(error))
    log = trace.tables["data_log"].to_pylist()[0]
    mapping = None if format_title_and_ego(log["format"]) else request.mapping or log["format"]
    return model.Inspection(
        file=msgspec.convert({**log, "name": name, "bytes": size}, model.File),
        content=file_content(path, mapping, list(trace.notes), has_reader=True),
        drive=_inspect_drive(trace, library, rules, request, selection),
    )


def to_json(inspection: model.Inspection) -> str:
    """Return an inspection as JSON with the structure of `schemas/inspect.schema.json`."""
    return msgspec.json.format(msgspec.json.encode(inspection), indent=2).decode()


def exit_code(inspection: model.Inspection) -> ExitCode:
    """Return 0 if the log can be read as a drive and its map fits, else 4."""
    unfit = inspection.problem is not None or (
        inspection.drive is not None and inspection.drive.road_problem is not None
    )
    return ExitCode.NOT_JUDGED if unfit else ExitCode.OK


def _content_of_unread_log(path: Path, options: IngestOptions) -> model.Content:
    try:
        return file_content(path, None, [], has_reader=not may_be_mapped_table(path, options))
    except (TraceError, OSError):  # the reader has already reported this problem
        return model.Content()


def _inspect_drive(
    trace: Trace, library: MapLibrary, rules: Sequence[Rule], request: InspectRequest, selection: Sequence[str]
) -> model.Drive:
    trace, environment, road_problem = _trace_map_and_problem(trace, library)
    actors = tracks.actors(trace)
    egos, quality = _egos_and_quality(trace, environment, actors, rules, road_problem, memory=request.memory)
    supposed, candidates = None, []
    if not egos:
        candidates = tracks.ego_candidates(actors)
        supposing = replace(request, ego=candidates[0].actor_id).ingest_options(need_ego=False)
        again = read_trace(trace.path, supposing)
        ((supposed,), _) = _egos_and_quality(again, environment, actors, rules, road_problem, memory=request.memory)
    return model.Drive(
        clock=tracks.clock(trace),
        states=trace.tables["actor_state"].num_rows,
        classes=tracks.counts_by_actor_class(actors),
        egos=egos,
        ego_source=_ego_source_text(trace, request.ego),
        candidates=candidates,
        supposed=supposed,
        road=None if environment is None else _summarise_map(environment, from_option=request.map is not None),
        road_problem=road_problem,
        quality=quality,
        rules=[rule.id for rule in rules],
        selection=list(selection),
        drafts=[] if request.rules else [rule.id for rule in rules if rule.status != "stable"],
    )


def _trace_map_and_problem(trace: Trace, library: MapLibrary) -> tuple[Trace, MapTables | None, str | None]:
    try:
        drive = drive_with_map(trace, library)
    except MapError as error:
        return trace, None, str(error)
    rows = drive.trace.tables["quality"].to_pylist()
    problem = next((row["message"] for row in rows if row["check_id"] == OWN_MAP_UNUSABLE_CHECK), None)
    return drive.trace, drive.environment, problem if drive.environment is None else None


def _egos_and_quality(
    trace: Trace,
    environment: MapTables | None,
    actors: Sequence[model.Actor],
    rules: Sequence[Rule],
    road_problem: str | None,
    *,
    memory: int | None,
) -> tuple[list[model.Ego], list[model.Quality]]:
    """Derive the library tables of a drive; return its egos with their decidable rules, and its data-quality findings."""
    conditions = _KnownConditions()
    with store.temporary_database(memory) as con:
        session = JudgingSession(con, (), {}, None, observers=[conditions], memory=MemoryLimit(con, memory))
        session.judge([Judgeable(trace, environment)])
        rows = {table: _query_rows(con, f"FROM {table}") for table in ("capability", "exposure")}
        fits = _query_rows(con, statement("inspect/registration")) if environment is not None else []
        for fit in fits:
            fit["reason"] = reason_text.sentence(fit["reason"])
        registrations = {fit["ego_id"]: msgspec.convert(fit, model.MapRegistration) for fit in fits}
        start = trace.tables["data_log"]["t_start_ns"][0].as_py()
        quality = _quality_findings(con, start)
    log_format = trace.tables["data_log"]["format"][0].as_py()
    by_id = {actor.actor_id: actor for actor in actors}
    egos = []
    for way in sorted(rows["exposure"], key=lambda row: str(row["ego_id"])):
        ego_id = way["ego_id"]
        row_by_signal = {row["signal"]: row for row in rows["capability"] if row["ego_id"] == ego_id}
        lacking = {
            signal: reason_text.sentence(row["reason"]) for signal, row in row_by_signal.items() if not row["available"]
        }
        asks = {
            signal: reason_text.text_of(reason_text.parse_reason(row["reason"]).code).advice
            for signal, row in row_by_signal.items()
        }
        if road_problem is not None:
            lacking["map"] = "the map is not used (see above)"
        never = advice.reasons_of_never_known_signals(conditions.known_by_ego[ego_id], lacking)
        cannot = advice.undecided_rules(rules, lacking, never)
        undecided = {rule.rule_id for rule in cannot}
        egos.append(
            model.Ego(
                actor=by_id[ego_id],
                km=way["km"],
                steps=way["n_steps"],
                registration=registrations.get(ego_id),
                can=[rule.id for rule in rules if rule.id not in undecided],
                cannot=cannot,
                missing_signals=advice.missing_signals(cannot, {**never, **lacking}, log_format, asks),
            )
        )
    return egos, quality


class _KnownConditions:
    """Collects, while the tables exist, which conditions of each ego, including the speed limit, are known at any step."""

    def __init__(self) -> None:
        self.known_by_ego: dict[str, dict[str, bool]] = {}

    def __call__(self, con: duckdb.DuckDBPyConnection, _drives: Sequence[Judgeable], **_part: bool) -> None:
        columns = {**dict.fromkeys(conditions.RULE_CONDITION_VALUES), "limit": None}
        counts = ", ".join(f'count({"limit_mps" if c == "limit" else c}) > 0 AS "{c}"' for c in columns)
        for row in _query_rows(con, f"SELECT ego_id::VARCHAR AS ego_id, {counts} FROM ego_condition GROUP BY ego_id"):
            ego = row.pop("ego_id")
            self.known_by_ego[ego] = {c: row[c] or self.known_by_ego.get(ego, {}).get(c, False) for c in row}


def _quality_findings(con: duckdb.DuckDBPyConnection, start_ns: int) -> list[model.Quality]:
    rows = _query_rows(con, statement("inspect/quality"))
    for row in rows:
        row["first_at_s"] = None if row["t_first_ns"] is None else (row["t_first_ns"] - start_ns) / 1e9
    return sorted(msgspec.convert(rows, list[model.Quality]), key=lambda q: _SEVERITIES.index(q.severity))


def _query_rows(con: duckdb.DuckDBPyConnection, sql: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = con.execute(sql).to_arrow_table().to_pylist()
    return rows


def _ego_source_text(trace: Trace, ego_option: str | None) -> str:
    if ego_option is not None:
        return "every motor vehicle in turn (--ego all)" if ego_option == "all" else "chosen with --ego"
    messages = {row["check_id"]: row["message"] for row in trace.tables["quality"].to_pylist()}
    if "no_ego" in messages:
        return str(messages["no_ego"])
    if "ego_assumed" in messages:
        return "assumed: the first vehicle of the file, as the mapping says (--ego ID to choose another)"
    log_format = trace.tables["data_log"]["format"][0].as_py()
    words = format_title_and_ego(log_format)
    return words[1] if words else f"named by the mapping {log_format}"


def _summarise_map(environment: MapTables, *, from_option: bool) -> model.Road:
    row = environment.tables["environment"].to_pylist()[0]
    lanelets = environment.tables["lanelet"]
    drivable = lanelets.filter(lanelets["drivable"])
    more = {
        "source": "option" if from_option else "log",
        "offset_m": (row["offset_x_m"], row["offset_y_m"]),
        "lanelets": lanelets.num_rows,
        "drivable": drivable.num_rows,
        "drivable_km": sum(drivable["length_m"].to_pylist()) / 1000,
    }
    return msgspec.convert(row | more, model.Road)
