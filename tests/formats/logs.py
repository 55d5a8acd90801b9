"""Writes small tables and mappings, and reads traces back as plain rows."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent
from typing import TYPE_CHECKING, Any

from drivelint.drive.trace import IngestOptions, Trace
from drivelint.formats import read_trace

if TYPE_CHECKING:
    import pyarrow as pa

LONG = """
description = "long table of the tests"
[time]
column = "t"
[columns]
actor_id = "id"
x = "x"
y = "y"
yaw = "yaw"
vx = "vx"
vy = "vy"
length = 4.5
width = 1.8
[ego]
ids = ["a"]
"""


def put(path: Path, text: str) -> Path:
    """Write dedented text."""
    path.write_text(dedent(text).lstrip("\n"), encoding="utf-8")
    return path


def mapping(tmp_path: Path, text: str = LONG, **replace: str) -> str:
    """Write a mapping file and return its name; `replace` swaps whole lines by the key before their `=`."""
    lines = []
    for line in dedent(text).strip().splitlines():
        key = line.split("=")[0].strip()
        lines.append(replace.pop(key, line))
    assert not replace, f"no line for {replace}"
    return str(put(tmp_path / "mapping.toml", "\n".join(lines) + "\n"))


def read(path: Path, **options: Any) -> Trace:
    """Read a trace with options."""
    return read_trace(path, IngestOptions(**options))


def states(trace: Trace, actor: str | None = None) -> list[dict[str, Any]]:
    """Return the rows of actor_state, of one actor or all."""
    rows: list[dict[str, Any]] = trace.tables["actor_state"].to_pylist()
    return [row for row in rows if actor is None or row["actor_id"] == actor]


def at(trace: Trace, actor: str, t_s: float) -> dict[str, Any]:
    """Return the state of an actor at a time."""
    return next(row for row in states(trace, actor) if row["t_ns"] == round(t_s * 1e9))


def actors(trace: Trace) -> dict[str, dict[str, Any]]:
    """Return the actors by id."""
    return {row["actor_id"]: row for row in trace.tables["actor"].to_pylist()}


def quality(trace: Trace) -> dict[str, dict[str, Any]]:
    """Return the quality rows by check; each check stands once in these tests."""
    rows = trace.tables["quality"].to_pylist()
    found = {row["check_id"]: row for row in rows}
    assert len(found) == len(rows), [row["check_id"] for row in rows]
    return found


def messages(trace: Trace, check: str) -> list[str]:
    """Return what the rows of a check say, however many."""
    return [row["message"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == check]


def size(trace: Trace, actor: str = "ego") -> tuple[float | None, ...]:
    """Return length, width and height of an actor."""
    row = actors(trace)[actor]
    return row["length_m"], row["width_m"], row["height_m"]


def egos(trace: Trace) -> list[str]:
    return [name for name, row in actors(trace).items() if row["is_ego"]]


def classes(trace: Trace) -> dict[str, str | None]:
    return {name: row["actor_class"] for name, row in actors(trace).items()}


def without_id(trace: Trace, table: str = "actor_state") -> pa.Table:
    """Return a table without the id of the drive, which is that of the file."""
    return trace.tables[table].drop_columns("drive_id")


def log(trace: Trace) -> dict[str, Any]:
    """Return the row of data_log."""
    row: dict[str, Any] = trace.tables["data_log"].to_pylist()[0]
    return row


def cars(n: int = 20, dt: float = 0.1, speed: float = 10.0, ids: tuple[str, ...] = ("a", "b")) -> list[str]:
    """Return CSV lines of cars that drive east, in the columns of `LONG`."""
    rows = ["t,id,x,y,yaw,vx,vy"]
    for i in range(n):
        rows += [f"{i * dt:.3f},{name},{i * dt * speed:.4f},{4.0 * k},0.0,{speed},0.0" for k, name in enumerate(ids)]
    return rows


def table(path: Path, lines: list[str]) -> Path:
    """Write CSV lines."""
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path
