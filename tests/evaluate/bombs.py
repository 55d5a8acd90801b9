"""Rules that take time or memory without end, made only of what a rule may be made of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from tests.evaluate import packs

if TYPE_CHECKING:
    from pathlib import Path

_SPEED: Final = (
    "SELECT drive_id, ego_id, t_ns, speed_mps + 0 * ({}) AS observed, 10.0::DOUBLE AS required FROM ego_state"
)
_TEXT: Final = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 10.0::DOUBLE AS required, {} FROM ego_state"

OF_TIME: Final = {
    "rows": "SELECT count(*) FROM range(2000000000000) t(i) WHERE sin(i) > 2",
    "series": "SELECT count(*) FROM generate_series(1, 2000000000000) t(i) WHERE cos(i) > 2",
    "cross_join": "SELECT count(*) FROM range(10000000) a(i), range(10000000) b(i) WHERE sin(a.i + b.i) > 2",
    "states_by_states": "SELECT count(*) FROM ego_state a, ego_state b, ego_state c, ego_state d"
    " WHERE sin(a.t_ns + b.t_ns + c.t_ns + d.t_ns) > 2",
    "distinct": "SELECT count(DISTINCT i % 1000 + 0.5) FROM range(2000000000000) t(i)",
    "nested_lambda": "list_sum(list_transform(range(60000), lambda x: list_sum(list_transform(range(60000), lambda y: sin(x + y)))))",
    "lambda_per_row": "list_sum(list_transform(range(20000), lambda x:"
    " list_sum(list_transform(range(20000), lambda y: sin(x + y + t_ns)))))",
    "pattern": "SELECT count(*) FROM range(1000000) t(i) WHERE regexp_matches(printf('%30000d', i), '( | )*( |  )+b')",
    "quantile": "SELECT median(sin(i)) FROM range(2000000000000) t(i) WHERE i % 1000000 = 0",
    "windowed": "SELECT max(s) FROM (SELECT sum(sin(i)) OVER (ORDER BY i % 1000) s FROM range(2000000000000) t(i) WHERE i % 100000 = 0)",
}
"""Expressions that run for hours in little memory; some of them do not heed an interrupt."""
OF_MEMORY: Final = {
    "padded": "length(printf('%2000000000d', t_ns))",
    "formatted": "length(format('{:2000000000d}', t_ns))",
    "range_per_row": "len(range(400000000 + t_ns % 7))",
    "lambda_of_lists": "len(list_transform(range(2000000 + t_ns % 7), lambda x: range(1000)))",
    "sorted_list": "list_max(list_sort(list_transform(range(30000000 + t_ns % 7), lambda x: sin(x))))",
    "distinct_list": "len(list_distinct(range(30000000 + t_ns % 7)))",
    "replaced": "length(replace(printf('%200000000d', t_ns), ' ', 'many words'))",
    "listed": "SELECT len(list(i ORDER BY sin(i))) FROM range(5000000000) t(i)",
    "joined_text": "SELECT length(string_agg(printf('%1000d', i), '' ORDER BY i)) FROM range(100000000) t(i)",
}
"""Expressions that take many gigabytes, by one value, by one vector of values or by one table."""
OF_TEXT: Final = {
    "long_reason": "printf('%20000000d', t_ns) AS reason",
    "long_code": "printf('%200000d', t_ns) AS reason_code",
    "many_long_reasons": "list_reverse(string_split(printf('%20000000d', t_ns), 'x'))[1] AS reason",
}
BOMBS: Final = {
    **{name: _SPEED.format(each) for name, each in {**OF_TIME, **OF_MEMORY}.items()},
    **{name: _TEXT.format(each) for name, each in OF_TEXT.items()},
}
HARMLESS: Final = _SPEED.format("1")


def write_pack(folder: Path, names: tuple[str, ...], *, pack: str = "bomb") -> Path:
    """Write a folder of packs with one that has these bombs, and a harmless rule; return it."""
    (folder / pack).mkdir(parents=True)
    for name, sql in {**{name: BOMBS[name] for name in names}, "harmless": HARMLESS}.items():
        (folder / pack / f"{name}.sql").write_text(packs.invariant(sql), encoding="utf-8")
    return folder
