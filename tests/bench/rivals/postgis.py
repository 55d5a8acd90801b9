"""End to end against PostGIS: set-based and indexed, and with one query per time step as the paper's prototype had it.

Both answer: the lanelets under every box centre; for every pair of the ego with another, the gap if under 30 m, contact, and the
three meetings of danger spaces as rectangles. Ours judges the whole catalogue as well, and decodes the log; PostgreSQL is given
the states as CSV files that were made before the clock started.
"""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint import catalogue
from drivelint.drive.trace import DriveInput, IngestOptions
from drivelint.engine.batch import Drive
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.formats import read_trace
from drivelint.sql import store
from tests.bench.clock import now, repeat
from tests.bench.rivals.comparison import agree
from tests.bench.rivals.postgres import database
from tests.bench.table import Bar, Row

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.bench.place import Place

    Answer = Sequence[float]

ANSWERS: Final = (
    "lanelets under centres",
    "gaps under 30 m",
    "sum of gaps",
    "contacts",
    "in the ego's danger space",
    "ego in theirs",
    "danger spaces that meet",
)
_TOLERANCE: Final = {"lanelets under centres": 1e-3}  # at the ends of lanelets, chords of different curves
# rectangles as boxes of their own: centre, half lengths; by separating axes, behind circles
_ANSWER: Final = """
WITH placed AS (
    SELECT drive_id, actor_id, t_ns, x_m, y_m, cos(yaw_rad) AS c, sin(yaw_rad) AS s, length_m / 2 AS hl, width_m / 2 AS hw,
        danger_space_m(speed_mps) AS sd FROM state_dynamics
),
both_ AS (
    SELECT e.hl AS ehl, e.hw AS ehw, o.hl AS ohl, o.hw AS ohw, e.sd AS esd, o.sd AS osd,
        (o.x_m - e.x_m) * e.c + (o.y_m - e.y_m) * e.s AS dx, (o.y_m - e.y_m) * e.c - (o.x_m - e.x_m) * e.s AS dy,
        o.c * e.c + o.s * e.s AS c, o.s * e.c - o.c * e.s AS s
    FROM step k
    JOIN placed e ON e.drive_id = k.drive_id AND e.actor_id = k.ego_id AND e.t_ns = k.t_ns
    JOIN placed o ON o.drive_id = k.drive_id AND o.t_ns = k.t_ns AND o.actor_id <> k.ego_id
),
near AS (SELECT * FROM both_ WHERE dx * dx + dy * dy <= (ehl + ehw + ohl + ohw + esd + osd) ** 2),
met AS (
    SELECT
        esd > 0 AND box_separation(dx - ehl - esd / 2, dy, c, s, esd / 2, ehw, ohl, ohw) <= 0 AS in_ours,
        osd > 0 AND box_separation(dx + c * (ohl + osd / 2), dy + s * (ohl + osd / 2), c, s, ehl, ehw, osd / 2, ohw) <= 0 AS in_theirs,
        esd > 0 AND osd > 0 AND box_separation(
            dx + c * (ohl + osd / 2) - ehl - esd / 2, dy + s * (ohl + osd / 2), c, s, esd / 2, ehw, osd / 2, ohw
        ) <= 0 AS both_spaces
    FROM near
)
SELECT (SELECT count(lanelet_id) FROM lane_occupancy), p.*, m.*
FROM (
    SELECT count(*), sum(greatest(clearance_m, 0.0)), count(*) FILTER (clearance_m <= 0) FROM pair
    WHERE NOT clearance_is_bound AND clearance_m <= 30
) p,
(SELECT count(*) FILTER (in_ours), count(*) FILTER (in_theirs), count(*) FILTER (both_spaces) FROM met) m
"""


_STATES: Final = """
SELECT s.actor_id, s.t_ns, s.x_m, s.y_m, s.yaw_rad, sqrt(s.vx_mps ** 2 + s.vy_mps ** 2), a.length_m, a.width_m, a.is_ego
FROM actor_state s JOIN actor a USING (drive_id, actor_id) ORDER BY s.t_ns, s.actor_id
"""
_TIMES: Final = (
    "SELECT t_ns FROM actor_state SEMI JOIN (SELECT * FROM actor WHERE is_ego) USING (drive_id, actor_id) ORDER BY t_ns"
)
_LANES: Final = """
SELECT lanelet_id, 'POLYGON((' || string_agg(format('{} {}', x, y), ',' ORDER BY n) || '))'
FROM (
    SELECT lanelet_id, k AS n, left_x_m AS x, left_y_m AS y FROM lane_point
    UNION ALL SELECT lanelet_id, 1000000 - k, right_x_m, right_y_m FROM lane_point
    UNION ALL SELECT lanelet_id, 2000000, left_x_m, left_y_m FROM lane_point WHERE k = 0
)
GROUP BY lanelet_id ORDER BY lanelet_id
"""


def compare(place: Place) -> list[Row]:
    """Compare the reference drive end to end; errors: `Skipped` without PostGIS."""
    runs = place.sizes.slow_runs
    script, times = _script(place)
    with database() as base:
        mine: list[Answer] = []
        theirs: list[Answer] = []

        def whole() -> None:
            base.renew()
            theirs.extend(base.run("\n".join(script[part] for part in ("load", "index", "derive", "assert"))))

        ours = repeat(lambda: mine.append(_our_answer(place)), runs)
        set_based = repeat(whole, runs)
        _agree(mine[-1], theirs[-1])
        begin = now()
        base.renew()
        base.run("\n".join(script[part] for part in ("load", "index", "derive")))
        prepared = now() - begin
        asked = times[: place.sizes.steps]
        begin = now()
        steps = base.run("\n".join(script["step"].format(t_ns=t) for t in asked))
        looped = now() - begin
    if len(asked) == len(times):
        _agree(mine[-1], [sum(column) for column in zip(*steps, strict=True)])
    loop = prepared.wall + looped.wall * len(times) / len(asked)
    scaled = "" if len(asked) == len(times) else f", from {len(asked):,} of them"
    row = partial(Row, "PostGIS")
    return [
        row("ours, end to end", ours.wall, cpu=ours.cpu, note=f"decoding, whole catalogue; median of {runs}"),
        row(
            "theirs, set-based and indexed",
            set_based.wall,
            note=f"from CSV, {len(ANSWERS)} questions; median of {runs}",
        ),
        row("ours is faster", set_based.wall / ours.wall, "x", bar=Bar(5.0, at_least=True)),
        row("theirs, a query per time step", loop, note=f"indexed, {len(times):,} steps{scaled}; once"),
        row("ours is faster", loop / ours.wall, "x", bar=Bar(20.0, at_least=True)),
    ]


def _read(place: Place) -> Drive:
    trace = read_trace(place.reference, IngestOptions())
    return Drive(trace, MapLibrary(DriveInput(map=place.road)).find(trace)[0])


def _our_answer(place: Place) -> Answer:
    """Judge the reference drive by the whole catalogue, and answer what PostGIS is asked."""
    found: list[Answer] = []

    def witness(con: duckdb.DuckDBPyConnection, _drives: Sequence[Drive], **_part: bool) -> None:
        found.extend(con.execute(_ANSWER).fetchall())

    rules = catalogue.select_rules(catalogue.load_rules(()), ("ukhc",), ())
    with store.connect() as con:
        store.insert(con, "profile", profile_table(load_profiles(()), ()))
        bench = JudgingSession(con, rules, catalogue.parse_params(rules, ()), None, observers=[witness])
        bench.judge([_read(place)])
        bench.close()
    return found[0]


def _script(place: Place) -> tuple[dict[str, str], list[int]]:
    """Return the sections of postgis.sql, its files having been written, and the times of the steps."""
    files = {"states": place.home / "states.csv", "lanes": place.home / "lanes.csv"}
    drive = _read(place)
    assert drive.environment
    with duckdb.connect() as con:
        for table in ("actor", "actor_state"):
            con.register(table, drive.trace.tables[table])
        con.register("lane_point", drive.environment.tables["lane_point"])
        for select, file in zip((_STATES, _LANES), files.values(), strict=True):
            con.execute(f"COPY ({select}) TO '{file}' (FORMAT csv, HEADER false)")
        times = [t for (t,) in con.execute(_TIMES).fetchall()]
    text = Path(__file__).with_suffix(".sql").read_text(encoding="utf-8")
    parts = re.split(r"^-- @(\w+)\n", text, flags=re.MULTILINE)[1:]
    script = dict(zip(parts[::2], parts[1::2], strict=True))
    script["load"] = script["load"].format(**files)
    return script, times


def _agree(our_answer: Answer, their_answer: Answer) -> None:
    for what, a, b in zip(ANSWERS, our_answer, their_answer, strict=True):
        agree(what, a, b, _TOLERANCE.get(what, 1e-6))
