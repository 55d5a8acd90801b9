#!/usr/bin/env bash
# DuckDB 1.5.5 with its spatial extension: `ST_Translate` of lanes that have heights, as a map is fitted to a log or moved to the log's origin.
#
# Expected: `ST_Translate(lane, 0.3, 0.4)` moves each point by 0.3 m and 0.4 m and leaves its height; with a third number, the height moves by it. PostGIS does so, and
# DuckDB itself for lanes without heights.
# Seen, without a word:
#   1. Each point moves by its height times 0.3 m and 0.4 m: a road at height 0 stays, one at 1 m is right, a ramp from 0 m to 6 m turns, a bridge at 6 m moves six times
#      as far. A line of points with a measure M (LINESTRING M) moves by M times that.
#   2. With a third number the height stays, and the number is added to x. So it is for lanes without heights.
#   3. Where points have heights and a measure (LINESTRING ZM), `ST_Translate`, `ST_Scale`, `ST_Rotate` and `ST_Affine` set every measure to 0.
# Why it matters: a test with a flat map, or one at height 1, passes. In a map with heights above the sea, 0.3 m become 33 m; in one with heights above its origin, level
# ground stays beside the log and only ramps and bridges go away. A measure of 0 at all points is a track without time, a road axis without stations.
# `ST_Affine` with six numbers (a, b, d, e, xoff, yoff) moves lanes with heights rightly.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile duckdb==1.5.5 duckdb-extension-spatial==1.5.5 duckdb-extensions==1.5.5

cat >seen.py <<'PY'
import re
import sys

import duckdb
from duckdb_extensions import import_extension

import_extension("spatial")
connection = duckdb.connect()
connection.execute("LOAD spatial")
version = connection.execute("SELECT extension_version FROM duckdb_extensions() WHERE extension_name = 'spatial'").fetchone()[0]
print("DuckDB", duckdb.__version__, "spatial", version)


def points(expression, line):
    """The points of a line after a function, as tuples."""
    (text,) = connection.execute(f"SELECT ST_AsText({expression}) FROM (SELECT ST_GeomFromText(?) AS lane)", [line]).fetchone()
    return [tuple(float(number) for number in point.split()) for point in re.search(r"\((.*)\)", text)[1].split(",")]


def moves(expression, line):
    """How far each point of a line goes, in each of its numbers."""
    return [tuple(round(b - a, 6) for a, b in zip(*pair)) for pair in zip(points("lane", line), points(expression, line))]


LANES = {
    "without heights": "LINESTRING (0 0, 60 0)",
    "level at 0 m": "LINESTRING Z (0 0 0, 60 0 0)",
    "level at 1 m": "LINESTRING Z (0 0 1, 60 0 1)",
    "ramp to 6 m": "LINESTRING Z (0 0 0, 60 0 6)",
    "110 m above the sea": "LINESTRING Z (0 0 110, 60 0 110)",
    "M from 0 to 3 s": "LINESTRING M (0 0 0, 60 0 3)",
}
SHIFT, LIFT, AFFINE = "ST_Translate(lane, 0.3, 0.4)", "ST_Translate(lane, 0.3, 0.4, 5)", "ST_Affine(lane, 1, 0, 0, 1, 0.3, 0.4)"
seen = {(function, title): moves(function, line) for function in (SHIFT, LIFT, AFFINE) for title, line in LANES.items()}
for (function, title), steps in seen.items():
    print(f"{function}, {title}: moves by {steps[0]} and {steps[1]}")


def by_height(title):
    """The move that the third number of each point explains: times it, or plainly where the line has none."""
    factors = [point[2] if len(point) == 3 else 1 for point in points("lane", LANES[title])]
    return [tuple(round(number, 6) for number in (0.3 * factor, 0.4 * factor, 0)) for factor in factors]


def same(steps, expected):
    return all(all(abs(a - b) < 1e-6 for a, b in zip(step, target)) for step, target in zip(steps, expected, strict=True))


multiplied = all(same(seen[SHIFT, title], by_height(title)) for title in LANES)
beside = all(same(seen[LIFT, title], [(x + 5, y, 0) for x, y, _ in by_height(title)]) for title in LANES)
right = all(same(seen[AFFINE, title], [(0.3, 0.4, 0)] * 2) for title in LANES)
track = "LINESTRING ZM (0 0 100 7, 60 0 100 9)"
measures = {call: [point[3] for point in points(call, track)] for call in ("lane", SHIFT, AFFINE, "ST_Scale(lane, 2, 2)", "ST_Rotate(lane, 0.1)")}
for call, values in measures.items():
    print(f"measures of a ZM line, {call}: {values}")
lost = measures.pop("lane") == [7, 9] and all(values == [0, 0] for values in measures.values())
sys.exit(0 if multiplied and beside and right and lost else "changed: where lanes with heights or measures are moved to")
PY
HOME=$folder venv/bin/python seen.py
