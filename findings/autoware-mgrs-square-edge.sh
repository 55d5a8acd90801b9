#!/usr/bin/env bash
# Autoware's projector for Lanelet2 maps, `MGRSProjector`, as simple-lanelet2 1.2.3 has it on PyPI (with Autoware's extension for Python).
#
# Expected: a lane of 44 m that crosses the edge of an MGRS square of 100 km has 44 m; or an origin, which the projector takes, decides on one square.
# Seen: x and y are within the square of each point. The lane's points go from x = 7.3 m to x = 99992.7 m, its length is 0.00 m, and
# the origin changes nothing. The change of square is a line on stderr; the map is loaded without errors.
# Why it matters: such an edge is the meridian of each UTM zone (9 degrees east runs between Karlsruhe and Stuttgart), and each 100 km from it.
# Positions and lanes jump by 100 km in mid-drive; a length of 0 divides. UtmProjector with the same file gives 43.9 m.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile simple-lanelet2==1.2.3

venv/bin/python - <<'PY'
import sys
from pathlib import Path

from autoware_lanelet2_extension_python.projection import MGRSProjector
from lanelet2 import geometry, io
from lanelet2.projection import UtmProjector

longitudes = (8.9997, 8.9999, 9.0001, 9.0003)
nodes = "".join(
    f'<node id="{4 * side + k + 1}" lat="{49.0 + 0.00003 * side}" lon="{lon}" version="1"><tag k="ele" v="5"/></node>\n'
    for side in (0, 1)
    for k, lon in enumerate(longitudes)
)
ways = "".join(
    f'<way id="{11 + side}" version="1">' + "".join(f'<nd ref="{4 * side + k + 1}"/>' for k in range(4))
    + '<tag k="type" v="line_thin"/><tag k="subtype" v="solid"/></way>\n'
    for side in (0, 1)
)
lane = (
    '<relation id="20" version="1"><member type="way" ref="12" role="left"/><member type="way" ref="11" role="right"/>'
    '<tag k="type" v="lanelet"/><tag k="subtype" v="road"/><tag k="location" v="urban"/></relation>\n'
)
Path("map.osm").write_text(f'<osm version="0.6" generator="by hand">\n{nodes}{ways}{lane}</osm>\n')
lengths, errors = {}, []
for name, projector in (
    ("MGRSProjector, origin (0, 0)", MGRSProjector(io.Origin(0, 0))),
    ("MGRSProjector, origin (49, 9)", MGRSProjector(io.Origin(49, 9))),
    ("UtmProjector, origin (49, 9)", UtmProjector(io.Origin(49, 9))),
):
    loaded, problems = io.loadRobust("map.osm", projector)
    errors += problems
    lanelet = loaded.laneletLayer[20]
    lengths[name] = geometry.length2d(lanelet)
    print(f"{name}: x of the left line {[round(p.x, 1) for p in lanelet.leftBound]}, length {lengths[name]:.2f} m")
at_zero, at_place, utm = lengths.values()
sys.exit(0 if at_zero == at_place < 0.01 and 43 < utm < 45 and not errors else 1)
PY
