"""`<rule>.cases.yml`, the regression cases beside every rule, and their harness.

A list of cases; each fills tables with a tiny scene, judges the rule, and says what must come out:

    - name: faster than the limit            # shows: violation, if the name does not say it
      given:
        step: {t_s: 0..10 by 0.1}
        ego_state: {t_s: 0..10 by 0.1, speed_mps: {else: 12, 5.0..5.3: 14}, limit_mps: 13.4}
      params: {tolerance_mps: 0.2}           # optional
      missing: [indicator]                   # signals the log does not have; everything else the rule requires is there
      expect: [{verdict: fail, t_worst_s: 5.0, margin: -0.6}]
      findings: 1                            # optional

* `given`: table -> a block or a list of blocks. A column is a scalar (broadcast), a list, a range `a..b by c` (ends included) or
  `a..b` (spread over the block's length), or by time `{else: v, 5.0..5.3: w, 7.2: u}`. Seconds may stand for nanoseconds: `t_s` for `t_ns`.
  Drive 'd', ego 'e' and every other column that must not be NULL have defaults; the rest is NULL.
* `step`: only `t_s` is needed. Without it the steps are the times used in the other tables. `clock` and the rest of `step` are
  worked out (hole = longer than 2.5 median periods); a block `clock: {max_gap_s: 1}` replaces what it names.
* `expect`: a verdict, which then every row must have, or the list of all rows in order of time, profile and object, each with the
  columns that matter (`t_worst_s` for `t_worst_ns`; of `reason` a part is enough). Numbers must agree to the decimals written, at least two; 12 means 12.00.
* Over its cases a rule must show `clean`, `violation`, `boundary`, `not_applicable` and `unknown`: words of the name, or `shows:`.
"""

from __future__ import annotations

import re
from decimal import Decimal
from functools import cache
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import yaml

from drivelint import store
from drivelint.errors import RuleError
from drivelint.evaluate import evaluate

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    import duckdb

    from drivelint.catalogue import Rule

SHOWS = ("clean", "violation", "boundary", "not_applicable", "unknown")
_DRIVE, _EGO = "d", "e"
_NUMBER = r"-?\d+(?:\.\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\s*\.\.\s*({_NUMBER})(?:\s+by\s+(\d+(?:\.\d+)?))?")
_DURATIONS = frozenset({"period_ns", "max_gap_ns", "dt_ns"})
_ORDER = "drive_id, ego_id, coalesce(t_ref_ns, t_start_ns) NULLS LAST, profile NULLS LAST, object_id NULLS LAST, occurrence"

Row = dict[str, Any]


class CaseResult(NamedTuple):
    """One case: its name, whether what came out is what it expects, and the difference if not."""

    name: str
    ok: bool
    message: str


class Case(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One case as written."""

    name: str
    given: dict[str, Any]
    expect: str | list[dict[str, Any]]
    shows: str | tuple[str, ...] = ()
    params: dict[str, Any] = {}
    missing: tuple[str, ...] = ()
    findings: int | None = None

    def categories(self) -> set[str]:
        """Return which of SHOWS this case shows, by its own word or by its name."""
        said = {self.shows} if isinstance(self.shows, str) else set(self.shows)
        words = re.sub(r"[\s_-]+", "_", self.name.lower())
        return said or {name for name in SHOWS if re.search(rf"(^|_){name}(_|$)", re.sub(r"[^a-z_]", "", words))}


class _Loader(yaml.SafeLoader):
    """YAML in which `off` and `on` are words: an indicator is off, not false."""


_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))


def read_cases(rule: Rule) -> list[Case]:
    """Read the rule's cases. Errors: `RuleError` where the file is missing, is not YAML, or says what is not understood."""
    file = rule.path.with_suffix(".cases.yml")
    try:
        raw = yaml.load(file.read_text(encoding="utf-8"), Loader=_Loader)  # noqa: S506 - a safe loader with fewer booleans
        cases = msgspec.convert(raw, list[Case])
    except FileNotFoundError as error:
        raise RuleError(f"{file}: rule {rule.id} has no cases; write clean, violation, boundary, not applicable and unknown") from error
    except yaml.YAMLError as error:
        raise RuleError(f"{file}: not YAML: {' '.join(str(error).split())}") from error
    except msgspec.ValidationError as error:
        raise RuleError(f"{file}: {error}") from error
    names = [case.name for case in cases]
    if len(set(names)) != len(names):
        raise RuleError(f"{file}: two cases have the same name: {next(n for n in names if names.count(n) > 1)!r}")
    return cases


def run_cases(rule: Rule) -> list[CaseResult]:
    """Run every case beside the rule, in order, and one more result: that all kinds of case are there and say what they mean.

    Errors: `RuleError` for a cases file that cannot be read.
    """
    cases = read_cases(rule)
    results = [run_case(rule, case) for case in cases]
    problem = _coverage(cases)
    return [*results, CaseResult("kinds of case", not problem, problem)]


def _coverage(cases: Sequence[Case]) -> str:
    shown = {name for case in cases for name in case.categories()}
    if unknown := sorted(shown - set(SHOWS)):
        return f"shows: {unknown[0]!r} is not one of {', '.join(SHOWS)}"
    if lacking := [name for name in SHOWS if name not in shown]:
        return f"no case shows: {', '.join(lacking)}"
    honest = {"clean": "pass", "violation": "fail", "not_applicable": "not_applicable", "unknown": "unknown"}
    for case in cases:
        verdicts = {case.expect} if isinstance(case.expect, str) else {row.get("verdict") for row in case.expect}
        for name in sorted(case.categories() & honest.keys()):
            if honest[name] not in verdicts:
                return f"case {case.name!r} shows {name} but expects no {honest[name]}"
    return ""


def run_case(rule: Rule, case: Case) -> CaseResult:
    """Fill a scene, judge it by this rule alone, compare."""
    con = _database()
    filled = ["verdict", "finding", "margin"]
    try:
        for table, rows in _scene(rule, case).items():
            filled.append(table)
            _fill(con, table, rows)
        evaluate(con, [rule], {rule.id: case.params})
        rows = _fetch(con, f"SELECT * FROM verdict ORDER BY {_ORDER}")
        message = _difference(case.expect, rows)
        found = _fetch(con, "SELECT count(*) AS n FROM finding")[0]["n"]
        if not message and case.findings not in {None, found}:
            message = f"expected {case.findings} findings, got {found}"
    finally:
        con.execute(";".join(f"DELETE FROM {table}" for table in filled))
    return CaseResult(case.name, not message, message)


@cache
def _database() -> duckdb.DuckDBPyConnection:
    """One database for all cases of the process: every case leaves it empty."""
    return store.connect(threads=1)


class _Column(NamedTuple):
    type: str
    nullable: bool


@cache
def _tables() -> dict[str, dict[str, _Column]]:
    tables: dict[str, dict[str, _Column]] = {}
    found = _database().execute("SELECT table_name, column_name, data_type, is_nullable FROM duckdb_columns() WHERE NOT internal")
    for table, column, kind, nullable in found.fetchall():
        tables.setdefault(table, {})[column] = _Column(kind, nullable)
    return tables


# ---- the scene


def _scene(rule: Rule, case: Case) -> dict[str, list[Row]]:
    """Return table -> rows: what the case gives, and what follows from it."""
    scene = {table: _rows(table, given, f"{rule.id}, case {case.name!r}") for table, given in case.given.items()}
    clock = scene.pop("clock", [{}])
    scene["step"] = _steps(scene, clock[0].get("max_gap_ns"))
    scene["clock"] = _clocks(scene["step"], clock)
    subjects = [(row["drive_id"], row["ego_id"]) for row in scene["clock"]]
    logged = {row["drive_id"] for row in scene.get("data_log", ())}
    new = [{"drive_id": d, "sha256": f"hash of {d}"} for d in dict.fromkeys(d for d, _ in subjects) if d not in logged]
    scene["data_log"] = scene.get("data_log", []) + new
    answered = {row["signal"] for row in scene.get("capability", ())}
    signals = [s for s in dict.fromkeys([*rule.requires, *case.missing]) if s not in answered]
    scene["capability"] = scene.get("capability", []) + [
        {"drive_id": d, "ego_id": e, "signal": s, "available": s not in case.missing, "reason": f"no {s} in this log" if s in case.missing else "in the log"}
        for d, e in subjects
        for s in signals
    ]
    return scene


def _rows(table: str, given: Any, where: str) -> list[Row]:
    """Spread the blocks of one table into rows."""
    if table not in _tables():
        raise RuleError(f"{where}: there is no table {table!r}")
    blocks = given if isinstance(given, list) else [given]
    rows: list[Row] = []
    for block in blocks:
        if not isinstance(block, dict):
            raise RuleError(f"{where}: {table}: a block is 'column: value' pairs, not {block!r}")
        rows += _block(table, block, f"{where}: {table}")
    return rows


def _block(table: str, block: Mapping[str, Any], where: str) -> list[Row]:
    columns: dict[str, Any] = {}
    for name, value in block.items():
        column, scale = _column(table, name, where)
        columns[column] = _values(value, scale)
    lengths = {len(v) for v in columns.values() if isinstance(v, list)}
    if len(lengths) > 1:
        raise RuleError(f"{where}: columns of different length: {', '.join(str(n) for n in sorted(lengths))}")
    n = lengths.pop() if lengths else 1
    times = columns.get("t_ns")
    for column, value in columns.items():
        if isinstance(value, _Spread):
            columns[column] = value.over(n)
        elif isinstance(value, dict):
            columns[column] = _by_time(value, times, f"{where}.{column}")
        elif not isinstance(value, list):
            columns[column] = [value] * n
    defaults = {"drive_id": _DRIVE, "ego_id": _EGO} | {"max_gap_ns": None} if table == "clock" else {"drive_id": _DRIVE, "ego_id": _EGO}
    fill = {c: v for c, v in defaults.items() if c in _tables()[table] and c not in columns}
    return [fill | {column: values[i] for column, values in columns.items()} for i in range(n)]


def _column(table: str, name: str, where: str) -> tuple[str, int]:
    """Return the column meant and what its values are multiplied by: `t_s` means `t_ns`."""
    columns = _tables()[table]
    if name in columns:
        return name, 1
    if name.endswith("_s") and f"{name[:-2]}_ns" in columns:
        return f"{name[:-2]}_ns", 1_000_000_000
    raise RuleError(f"{where} has no column {name!r}; it has: {', '.join(columns)}")


class _Spread(NamedTuple):
    """`a..b`: evenly over as many rows as the block has."""

    first: Decimal
    last: Decimal
    scale: int

    def over(self, n: int) -> list[float | int]:
        step = (self.last - self.first) / max(n - 1, 1)
        return [_scaled(self.first + step * i, self.scale) for i in range(n)]


def _scaled(value: Decimal, scale: int) -> float | int:
    return round(value * scale) if scale != 1 else float(value)


def _values(value: Any, scale: int) -> Any:
    """Return a list, a scalar, a spread or a by-time mapping, in the column's own unit."""
    if isinstance(value, list):
        return [_values(item, scale) for item in value]
    if isinstance(value, dict):
        return {key: _values(item, scale) for key, item in value.items()}
    if isinstance(value, str) and (match := _RANGE.fullmatch(value.strip())):
        first, last = Decimal(match[1]), Decimal(match[2])
        if match[3] is None:
            return _Spread(first, last, scale)
        step = Decimal(match[3])
        return [_scaled(first + step * i, scale) for i in range(int((last - first) / step + Decimal("1e-9")) + 1)]
    if scale != 1 and isinstance(value, int | float) and not isinstance(value, bool):
        return _scaled(Decimal(str(value)), scale)
    return value


def _by_time(value: Mapping[Any, Any], times: Any, where: str) -> list[Any]:
    """Choose each row's value by its time; later entries win."""
    if not isinstance(times, list):
        raise RuleError(f"{where}: a value by time needs the times: t_s as a list or range")
    rows = [value.get("else")] * len(times)
    for key, chosen in value.items():
        if key == "else":
            continue
        match = _RANGE.fullmatch(str(key)) or re.fullmatch(rf"({_NUMBER})()()", str(key))
        if not match:
            raise RuleError(f"{where}: {key!r} is no time: write 5.0, 5.0..5.3 or else")
        first = round(Decimal(match[1]) * 10**9)
        last = round(Decimal(match[2] or match[1]) * 10**9)
        rows = [chosen if first <= t <= last else old for t, old in zip(times, rows, strict=True)]
    return rows


def _steps(scene: Mapping[str, Sequence[Row]], max_gap_ns: int | None) -> list[Row]:
    """Return the step rows of every subject, from `step` or from the times that the scene uses."""
    times: dict[tuple[str, str], set[int]] = {}
    sources = {"step": scene["step"]} if "step" in scene else scene
    grids = {c for rows in sources.values() for row in rows for c in row if c == "t_ns"} or None
    for rows in sources.values():
        for row in rows:
            used = [v for c, v in row.items() if (c in grids if grids else c.endswith("_ns") and c not in _DURATIONS) and v is not None]
            times.setdefault((row.get("drive_id", _DRIVE), row.get("ego_id", _EGO)), set()).update(used)
    given = {(row["drive_id"], row["ego_id"], row["t_ns"]): row for row in sources.get("step", ())}
    steps: list[Row] = []
    for (drive, ego), used in times.items():
        ordered = sorted(used)
        gap = max_gap_ns or _period(ordered) * 5 // 2
        seg = 0
        for k, t in enumerate(ordered):
            dt = t - ordered[k - 1] if k else None
            seg += dt is not None and dt > gap
            steps.append({"drive_id": drive, "ego_id": ego, "t_ns": t, "k": k, "dt_ns": dt, "seg": seg} | given.get((drive, ego, t), {}))
    return steps


def _period(ordered: Sequence[int]) -> int:
    return int(median(b - a for a, b in zip(ordered, ordered[1:], strict=False))) if len(ordered) > 1 else 100_000_000


def _clocks(steps: Iterable[Row], given: Sequence[Row]) -> list[Row]:
    """Return one clock per subject, with what the case says about it."""
    times: dict[tuple[str, str], list[int]] = {}
    for row in steps:
        times.setdefault((row["drive_id"], row["ego_id"]), []).append(row["t_ns"])
    said = {(row.get("drive_id", _DRIVE), row.get("ego_id", _EGO)): row for row in given if row}
    clocks = []
    for drive, ego in dict.fromkeys([*times, *said]):
        used = sorted(times.get((drive, ego), [0]))
        period = _period(used)
        own = {c: v for c, v in said.get((drive, ego), {}).items() if v is not None}
        clocks.append(
            {"drive_id": drive, "ego_id": ego, "period_ns": period, "max_gap_ns": period * 5 // 2, "t_start_ns": used[0], "t_end_ns": used[-1]} | own
        )
    return clocks


def _fill(con: duckdb.DuckDBPyConnection, table: str, rows: Sequence[Row]) -> None:
    """Insert rows; columns that must not be NULL and are not given get a default of their type."""
    import pyarrow as pa

    if not rows:
        return
    zero = {"VARCHAR": "", "BOOLEAN": False, "DOUBLE": 0.0}
    defaults = {c: zero.get(column.type, 0) for c, column in _tables()[table].items() if not column.nullable}
    names = dict.fromkeys([*defaults, *(c for row in rows for c in row)])
    store.insert(con, table, pa.table({c: [row.get(c, defaults.get(c)) for row in rows] for c in names}))


# ---- what came out


def _fetch(con: duckdb.DuckDBPyConnection, sql: str) -> list[Row]:
    result = con.execute(sql)
    names = [column[0] for column in result.description or ()]
    return [dict(zip(names, row, strict=True)) for row in result.fetchall()]


def _difference(expect: str | Sequence[Mapping[str, Any]], rows: Sequence[Row]) -> str:
    """Return '' where the rows are as expected, else one line that says how they differ."""
    got = "; ".join(_brief(row) for row in rows)
    if isinstance(expect, str):
        wrong = [row for row in rows if row["verdict"] != expect]
        return f"expected {expect}, got {got}" if wrong or not rows else ""
    if len(expect) != len(rows):
        return f"expected {len(expect)} rows, got {len(rows)}: {got}"
    for n, (wanted, row) in enumerate(zip(expect, rows, strict=True)):
        for name, value in wanted.items():
            column, scale = _column("verdict", name, "expect")
            same = value in row[column] if name == "reason" else _same(value, row[column], scale)
            if not same:
                shown = row[column] if scale == 1 or row[column] is None else row[column] / scale
                return f"row {n}: expected {name} = {value!r}, got {shown!r}: {_brief(row)}"
    return ""


def _same(wanted: Any, got: Any, scale: int) -> bool:
    if isinstance(wanted, bool) or wanted is None or got is None or isinstance(wanted, str):
        return bool(wanted == got)
    if scale != 1 or isinstance(got, int):
        return bool(round(Decimal(str(wanted)) * scale) == got)
    exponent = Decimal(str(wanted)).as_tuple().exponent
    decimals = max(2, -exponent if isinstance(exponent, int) else 2)
    return abs(float(wanted) - float(got)) <= 0.5 * 10.0**-decimals + 1e-9


def _brief(row: Row) -> str:
    who = " ".join(str(row[c]) for c in ("profile", "object_id") if row[c] is not None)
    return f"{row['verdict']} ({row['reason_code']}{', ' + who if who else ''}: {row['reason']})"
