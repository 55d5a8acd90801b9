"""Completes the tables of a case from the columns, ranges and times that the case gives."""

from __future__ import annotations

import re
from decimal import Decimal
from functools import cache, partial
from itertools import pairwise
from statistics import median
from typing import TYPE_CHECKING, Any

import duckdb

from drivelint.catalogue.check import collect_problems, raise_problems
from drivelint.errors import RuleError
from drivelint.phrases import hint
from drivelint.sql import declarations, store

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from drivelint.catalogue import Rule

_DRIVE, _EGO = "d", "e"
_NUMBER = r"-?\d+(?:\.\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\s*\.\.\s*({_NUMBER})(?:\s+by\s+(\d+(?:\.\d+)?))?")
_DURATION_COLUMNS = frozenset({"period_ns", "max_gap_ns", "dt_ns"})

Row = dict[str, Any]


@cache
def case_database() -> duckdb.DuckDBPyConnection:
    """Return the process's database for all cases, locked; every case leaves it empty."""
    con = store.connect(threads=1)
    store.lock_down(con)
    return con


@cache
def _column_defaults() -> dict[str, dict[str, Any]]:
    """Return, by table and column, the default of a NOT NULL column; None for a column that may be NULL."""
    zero = {"VARCHAR": "", "BOOLEAN": False, "DOUBLE": 0.0}
    tables: dict[str, dict[str, Any]] = {}
    columns = "SELECT table_name, column_name, data_type, is_nullable FROM duckdb_columns() WHERE NOT internal"
    for table, column, kind, nullable in case_database().execute(columns).fetchall():
        tables.setdefault(table, {})[column] = None if nullable else zero.get(kind, 0)
    return tables


def complete_scene(rule: Rule, given_tables: Mapping[str, Any], missing_signals: Sequence[str]) -> dict[str, list[Row]]:
    """Return the rows of each table: the rows in the case, and rows derived from these.

    Errors: `RuleError` with a line for each wrong table, column or word.
    """
    scene: dict[str, list[Row]] = {}
    problems: list[str] = []
    for table, blocks in given_tables.items():
        with collect_problems(problems):
            scene[table] = rows_of_blocks(table, blocks, f"given: {table}")
    raise_problems(problems)
    clock = scene.pop("clock", [{}])
    scene["step"] = _step_rows(scene, clock[0].get("max_gap_ns"))
    scene["clock"] = _clock_rows(scene["step"], clock)
    scene["ego_condition"] = _condition_rows(scene["step"], scene.get("ego_condition", ()))
    subjects = [(row["drive_id"], row["ego_id"]) for row in scene["clock"]]
    logged = {row["drive_id"] for row in scene.get("data_log", ())}
    new = [{"drive_id": d, "sha256": f"hash of {d}"} for d in dict.fromkeys(d for d, _ in subjects) if d not in logged]
    scene["data_log"] = [*scene.get("data_log", ()), *new]
    answered = {row["signal"] for row in scene.get("capability", ())}
    signals = [s for s in dict.fromkeys([*rule.requires, *missing_signals]) if s not in answered]
    scene["capability"] = scene.get("capability", []) + [
        {
            "drive_id": d,
            "ego_id": e,
            "signal": s,
            "available": s not in missing_signals,
            "reason": f"no {s} in this log" if s in missing_signals else "in the log",
        }
        for d, e in subjects
        for s in signals
    ]
    return scene


def complete_table_scene(reads: Collection[str], given_tables: Mapping[str, Any], map_id: str) -> dict[str, list[Row]]:
    """Return the rows of the tables that a SELECT reads: those of the case, and clocks, steps and logs that it does not give.

    `map_id`: the map of rows that name none. Errors: `RuleError` with a line for each wrong table, column or word.
    """
    scene: dict[str, list[Row]] = {}
    problems: list[str] = []
    for table, blocks in given_tables.items():
        with collect_problems(problems):
            scene[table] = rows_of_blocks(table, blocks, f"given: {table}")
    raise_problems(problems)
    if computed := {"step", "clock", "_ego_clock"} & set(reads):
        clock_rows = {table: scene.pop(table, [{}]) for table in ("clock", "_ego_clock")}
        clocks = clock_rows["clock"] if clock_rows["clock"] != [{}] else clock_rows["_ego_clock"]
        steps = _step_rows(scene, clocks[0].get("max_gap_ns"))
        scene |= {"step": steps, "clock": _clock_rows(steps, clocks), "_ego_clock": _clock_rows(steps, clocks)}
        for table in {"step", "clock", "_ego_clock"} - computed:
            del scene[table]
    if "data_log" in reads:
        drives = dict.fromkeys(row["drive_id"] for rows in scene.values() for row in rows if "drive_id" in row)
        logged = {row["drive_id"] for row in scene.get("data_log", ())}
        new = [{"drive_id": drive, "sha256": f"hash of {drive}"} for drive in drives if drive not in logged]
        scene["data_log"] = [*scene.get("data_log", ()), *new]
    for table, rows in scene.items():
        if "environment_id" in _column_defaults()[table]:
            scene[table] = [{"environment_id": map_id, **row} for row in rows]
    return scene


def rows_of_blocks(table: str, blocks: Any, where: str) -> list[Row]:
    """Return the rows that the blocks of one table describe. Errors: `RuleError`, with `where` the blocks stand."""
    if table not in _column_defaults():
        raise RuleError(f"given: there is no table {table!r}; {hint(table, _column_defaults())}")
    rows: list[Row] = []
    for block in blocks if isinstance(blocks, list) else [blocks]:
        if not isinstance(block, dict):
            raise RuleError(f"{where}: a block is 'column: value' pairs, not {block!r}")
        rows += _block_rows(table, block, where)
    return rows


def _block_rows(table: str, block: Mapping[str, Any], where: str) -> list[Row]:
    columns: dict[str, Any] = {}
    problems: list[str] = []
    for name, value in block.items():
        with collect_problems(problems):
            column, scale = column_and_factor(table, name, where)
            refuse_wrong_word(table, column, value, where)
            columns[column] = _values_in_column_unit(value, scale)
    raise_problems(problems)
    lengths = {len(v) for v in columns.values() if isinstance(v, list)}
    if len(lengths) > 1:
        raise RuleError(f"{where}: columns of different length: {', '.join(str(n) for n in sorted(lengths))}")
    n = lengths.pop() if lengths else 1
    times = columns.get("t_ns")
    for column, value in columns.items():
        if callable(value):
            columns[column] = value(n)
        elif isinstance(value, dict):
            columns[column] = _values_by_time(value, times, f"{where}.{column}")
        elif not isinstance(value, list):
            columns[column] = [value] * n
    defaults = {"drive_id": _DRIVE, "ego_id": _EGO}
    row_defaults = {c: v for c, v in defaults.items() if c in _column_defaults()[table] and c not in columns}
    return [row_defaults | {column: values[i] for column, values in columns.items()} for i in range(n)]


def column_and_factor(table: str, name: str, where: str) -> tuple[str, int]:
    """Return the column for a name in a case, and the factor of its values: for `t_s`, `t_ns` and 1e9. Errors: `RuleError`."""
    columns = _column_defaults()[table]
    if name in columns:
        return name, 1
    if name.endswith("_s") and f"{name[:-2]}_ns" in columns:
        return f"{name[:-2]}_ns", 1_000_000_000
    near = hint(name, columns)
    advice = near if near.startswith("did") else f"it has: {', '.join(columns)}"
    raise RuleError(f"{where} has no column {name!r}; {advice}")


def refuse_wrong_word(table: str, column: str, value: Any, where: str) -> None:
    """Raise `RuleError` for a word that is not in the column's vocabulary, with the most similar valid word.

    `value` may also be a list, or a mapping of times to words.
    """
    word_column = declarations.word_columns()[table].get(column)
    if word_column is None:
        return
    for word in _texts_in_value(value, word_column.field):
        if wrong := word_column.vocabulary.problem(word):
            raise RuleError(f"{where}.{column}: {wrong}")


def _texts_in_value(value: Any, field: str) -> Iterator[str]:
    """Yield the texts in a value; with `field`, only the texts under this key in its STRUCTs."""
    if isinstance(value, dict):
        inner = [(value[field], "")] if field in value else [(part, field) for part in value.values()]
    else:
        inner = [(part, field) for part in value] if isinstance(value, list) else []
    if isinstance(value, str) and not field:
        yield value
    for part, inner_field in inner:
        yield from _texts_in_value(part, inner_field)


def _evenly_spaced_values(first: Decimal, last: Decimal, scale: int, n: int) -> list[float | int]:
    step = (last - first) / max(n - 1, 1)
    return [_scale_value(first + step * i, scale) for i in range(n)]


def _scale_value(value: Decimal, scale: int) -> float | int:
    return round(value * scale) if scale != 1 else float(value)


def _values_in_column_unit(value: Any, scale: int) -> Any:
    """Return a value in the column's unit: a list, a scalar, a mapping by time, or for `a..b` a function of the number of rows."""
    if isinstance(value, list):
        return [_values_in_column_unit(item, scale) for item in value]
    if isinstance(value, dict):
        return {key: _values_in_column_unit(item, scale) for key, item in value.items()}
    if isinstance(value, str) and (match := _RANGE.fullmatch(value.strip())):
        first, last = Decimal(match[1]), Decimal(match[2])
        if match[3] is None:
            return partial(_evenly_spaced_values, first, last, scale)
        step = Decimal(match[3])
        return [_scale_value(first + step * i, scale) for i in range(int((last - first) / step + Decimal("1e-9")) + 1)]
    if scale != 1 and isinstance(value, int | float) and not isinstance(value, bool):
        return _scale_value(Decimal(str(value)), scale)
    return value


def _values_by_time(value: Mapping[Any, Any], times: Any, where: str) -> list[Any]:
    """Return the value of each row by its time; later entries take precedence."""
    if not isinstance(times, list):
        raise RuleError(f"{where}: a value by time needs the times: t_s as a list or range")
    rows = _spread(value.get("else"), len(times), f"{where}: else")
    for key, entry in value.items():
        if key == "else":
            continue
        match = _RANGE.fullmatch(str(key)) or re.fullmatch(rf"({_NUMBER})()()", str(key))
        if not match:
            raise RuleError(f"{where}: {key!r} is no time: write 5.0, 5.0..5.3 or 'else'")
        first = round(Decimal(match[1]) * 10**9)
        last = round(Decimal(match[2] or match[1]) * 10**9)
        hit = [i for i, t in enumerate(times) if first <= t <= last]
        for i, new in zip(hit, _spread(entry, len(hit), f"{where}: {key}"), strict=True):
            rows[i] = new
    return rows


def _spread(value: Any, n: int, where: str) -> list[Any]:
    """Return one value for each of n rows: `a..b` evenly spaced, a list as it is, anything else in each row."""
    if callable(value):
        spaced: list[Any] = value(n)
        return spaced
    if not isinstance(value, list):
        return [value] * n
    if len(value) != n:
        raise RuleError(f"{where}: {len(value)} values for {n} rows")
    return value


def _step_rows(scene: Mapping[str, Sequence[Row]], max_gap_ns: int | None) -> list[Row]:
    """Return the rows of `step` for each drive and ego, from the scene's table `step` or from the times in other tables."""
    grids = {t: rows for t, rows in scene.items() if rows and _has_row_per_step(t)}
    sources = {"step": scene["step"]} if "step" in scene else grids
    times: dict[tuple[str, str], set[int]] = {}
    for row in (row for rows in (sources or scene).values() for row in rows):
        names = (
            ["t_ns"] if sources else [name for name in row if name.endswith("_ns") and name not in _DURATION_COLUMNS]
        )
        used = {row[name] for name in names if row.get(name) is not None}
        times.setdefault((row.get("drive_id", _DRIVE), row.get("ego_id", _EGO)), set()).update(used)
    given_steps = {(row["drive_id"], row["ego_id"], row["t_ns"]): row for row in scene.get("step", ())}
    steps: list[Row] = []
    for (drive, ego), moments in times.items():
        ordered = sorted(moments)
        gap = max_gap_ns or _median_period_ns(ordered) * 5 // 2
        seg = 0
        for k, t in enumerate(ordered):
            dt = t - ordered[k - 1] if k else None
            seg += dt is not None and dt > gap
            step = {"drive_id": drive, "ego_id": ego, "t_ns": t, "k": k, "dt_ns": dt, "seg": seg}
            steps.append(step | given_steps.get((drive, ego, t), {}))
    return steps


def _condition_rows(steps: Iterable[Row], condition_rows: Iterable[Row]) -> list[Row]:
    """Return the conditions of every step; the default of `engaged` is true, other conditions are unknown by default."""
    keys = ("drive_id", "ego_id", "t_ns")
    given_rows = {tuple(row.get(key) for key in keys): row for row in condition_rows}
    at = dict.fromkeys([*(tuple(step[key] for key in keys) for step in steps), *given_rows])
    return [{**dict(zip(keys, key, strict=True)), "engaged": True, **given_rows.get(key, {})} for key in at]


def _has_row_per_step(table: str) -> bool:
    """Return whether a table has a row per step of the ego. Without such a table, the times of events are the steps."""
    columns = _column_defaults()[table]
    return {"ego_id", "t_ns"} <= columns.keys() and ("occurrence" not in columns or table.endswith("_step"))


def _median_period_ns(ordered: Sequence[int]) -> int:
    return int(median(b - a for a, b in pairwise(ordered))) if len(ordered) > 1 else 100_000_000


def _clock_rows(steps: Iterable[Row], clock_rows: Sequence[Row]) -> list[Row]:
    """Return one clock row per drive and ego; values of the case replace the defaults."""
    times: dict[tuple[str, str], list[int]] = {}
    for row in steps:
        times.setdefault((row["drive_id"], row["ego_id"]), []).append(row["t_ns"])
    given_clocks = {(row.get("drive_id", _DRIVE), row.get("ego_id", _EGO)): row for row in clock_rows if row}
    clocks = []
    for drive, ego in dict.fromkeys([*times, *given_clocks]):
        used = sorted(times.get((drive, ego), [0]))
        period = _median_period_ns(used)
        own_values = {c: v for c, v in given_clocks.get((drive, ego), {}).items() if v is not None}
        clock = {"drive_id": drive, "ego_id": ego, "period_ns": period, "max_gap_ns": period * 5 // 2}
        clocks.append(clock | {"t_start_ns": used[0], "t_end_ns": used[-1]} | own_values)
    return clocks


def insert_rows(con: duckdb.DuckDBPyConnection, table: str, rows: Sequence[Row]) -> None:
    """Insert rows into a table; missing NOT NULL columns get the default of their type.

    Errors: `RuleError` for a value that does not fit its column.
    """
    import pyarrow as pa

    if not rows:
        return
    defaults = {column: default for column, default in _column_defaults()[table].items() if default is not None}
    names = dict.fromkeys([*defaults, *(c for row in rows for c in row)])
    try:
        store.insert(con, table, pa.table({c: [row.get(c, defaults.get(c)) for row in rows] for c in names}))
    except (pa.ArrowException, duckdb.Error) as error:
        raise RuleError(f"given: {table}: {str(error).splitlines()[0]}") from error
