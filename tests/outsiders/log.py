"""A drive on disk as the outsiders were told of it: a folder of Parquet tables and a map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

_INTEGERS = {"t_ns"}
_FLAGS = {"is_ego"}
_UNITS = ("_m", "_rad", "_mps", "_mps2")
_VERDICTS = ("not fail", "not pass", "fail", "pass", "unknown", "not_applicable")
_PACKS = ("stvo.", "criticality.", "comfort.", "rss.", "performance.", "alks-r157.", "declared.")

Size = tuple[float | None, float | None, float | None]


class Scene(NamedTuple):
    """What happens in a drive, and what a careful examiner says of it: rule -> fail, pass, not fail, not pass, unknown."""

    name: str
    what: str
    expect: dict[str, str]


def judgements(text: str) -> dict[str, str]:
    """Read 'fail a b | pass c | not fail d': verdicts, and the rules that have them (of ukhc unless they say)."""
    wanted = {}
    for part in filter(None, (part.strip() for part in text.split("|"))):
        verdict = next(v for v in _VERDICTS if part.startswith(v))
        for rule in part.removeprefix(verdict).split():
            wanted[rule if rule.startswith(_PACKS) else f"ukhc.{rule}"] = verdict
    return wanted


class Box(NamedTuple):
    """A row of `actor`, the ego's if it is called that; None: the log does not know."""

    actor_id: str
    actor_class: str | None
    size: Size


def write(  # noqa: PLR0917
    folder: Path,
    road: str,
    boxes: Sequence[Box],
    states: Iterable[Mapping[str, Sequence[Any]]],
    conditions: Mapping[str, str],
    lights: Iterable[tuple[str, int, str]] = (),
    events: Iterable[tuple[float, str, str]] = (),
) -> None:
    """Write one drive; `states`: the columns of each actor; `lights`: (signal, ns, state); `events` of the ego: (s, event, value)."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "map.xodr").write_text(road, encoding="utf-8")
    sizes = dict(zip(("length_m", "width_m", "height_m"), zip(*(box.size for box in boxes), strict=True), strict=True))
    _table(
        folder / "actor.parquet",
        {
            "actor_id": [box.actor_id for box in boxes],
            "actor_class": [box.actor_class for box in boxes],
            **sizes,
            "is_ego": [box.actor_id == "ego" for box in boxes],
        },
    )
    parts = list(states)
    _table(folder / "actor_state.parquet", {name: [v for part in parts for v in part[name]] for name in parts[0]})
    _rows(folder / "drive_condition.parquet", ("condition", "value"), conditions.items())
    _rows(folder / "signal_state.parquet", ("signal_id", "t_ns", "state"), lights)
    said = [("ego", round(t * 1e9), event, value) for t, event, value in events]
    _rows(folder / "declared_event.parquet", ("actor_id", "t_ns", "event", "value"), said)


def at(steps: Sequence[tuple[float, str]], t: float) -> str:
    """Return the value that holds at a time."""
    return [value for when, value in steps if when <= t + 1e-9][-1]


def _rows(path: Path, names: Sequence[str], rows: Iterable[tuple[Any, ...]]) -> None:
    """Write a table of rows; without any there is no file."""
    if columns := list(zip(*rows, strict=True)):
        _table(path, dict(zip(names, columns, strict=True)))


def _table(path: Path, columns: Mapping[str, Sequence[Any]]) -> None:
    pq.write_table(pa.table({name: pa.array(values, _type(name)) for name, values in columns.items()}), path)


def _type(name: str) -> pa.DataType:
    if name in _INTEGERS:
        return pa.int64()
    if name in _FLAGS:
        return pa.bool_()
    return pa.float64() if name.endswith(_UNITS) else pa.string()
