"""Temporal conditions as windowed minima and maxima over every ego step: against rtamt, in discrete time."""

from __future__ import annotations

import json
from functools import partial
from typing import TYPE_CHECKING

from drivelint.sql import store
from tests.bench import traffic
from tests.bench.clock import Span, median, repeat
from tests.bench.rivals.comparison import agree, ask
from tests.bench.table import Bar, Row

if TYPE_CHECKING:
    from tests.bench.place import Place

PYTHON = "DRIVELINT_BENCH_RTAMT_PYTHON"
WINDOW_S = 5
# a pre-, a post- and an "eventually" condition, as the catalogue's temporal kinds have them
FORMULAS = (
    f"historically[0s,{WINDOW_S}s](speed >= 8.0)",
    f"always[0s,{WINDOW_S}s](gap >= 2.0)",
    f"eventually[0s,{WINDOW_S}s](gap >= 20.0)",
)
_ROBUSTNESS_SQL = """
CREATE OR REPLACE TEMP TABLE robust AS
SELECT t_ns, min(speed - 8.0) OVER (ORDER BY t_ns ROWS BETWEEN {n} PRECEDING AND CURRENT ROW) AS f0,
    min(gap - 2.0) OVER ahead AS f1, max(gap - 20.0) OVER ahead AS f2
FROM signal
WINDOW ahead AS (ORDER BY t_ns ROWS BETWEEN CURRENT ROW AND {n} FOLLOWING)
"""
_SIGNALS = """
CREATE TEMP TABLE signal AS
SELECT e.t_ns, any_value(sqrt(e.vx_mps ** 2 + e.vy_mps ** 2)) AS speed,
    min(sqrt((o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2)) - 4.8 AS gap
FROM states e JOIN states o ON o.t_ns = e.t_ns AND o.actor_id <> e.actor_id
WHERE e.actor_id = '0'
GROUP BY e.t_ns
ORDER BY e.t_ns
"""


def compare(place: Place) -> list[Row]:
    """Compare the robustness of three temporal formulas at every step of the reference drive."""
    shape, runs = place.sizes.reference, place.sizes.runs
    rows, _ = traffic.drive(shape)
    with store.connect() as con:
        con.register("states", rows)
        con.execute(_SIGNALS)
        signals = con.execute("SELECT speed, gap FROM signal ORDER BY t_ns").to_arrow_table()
        asked = {
            "signals": {name: signals[name].to_pylist() for name in signals.column_names},
            "period_ms": 1000 // shape.hertz,
            "formulas": FORMULAS,
        }
        file = place.home / "signals.json"
        file.write_text(json.dumps(asked), encoding="utf-8")
        theirs = ask("rtamt_script.py", "rtamt", PYTHON, file, runs)
        ours = repeat(partial(con.execute, _ROBUSTNESS_SQL.format(n=WINDOW_S * shape.hertz)), runs)
        found = con.execute("SELECT f0, f1, f2 FROM robust ORDER BY t_ns").fetchall()
    for formula, robustness, mine in zip(FORMULAS, theirs["robustness"], zip(*found, strict=True), strict=True):
        for a, b in zip(mine, robustness, strict=True):
            agree(formula, a, b)
    rtamt = median([Span(*t) for t in theirs["taken"]])
    note = f"{len(FORMULAS)} formulas, {len(found):,} steps, median of {runs}"
    return [
        Row("rtamt", "discrete time, offline", rtamt.wall, cpu=rtamt.cpu, note=note),
        Row("rtamt", "windows in one statement", ours.wall, cpu=ours.cpu),
        Row("rtamt", "ours is faster", rtamt.wall / ours.wall, "x", bar=Bar(3.0, at_least=True)),
    ]
