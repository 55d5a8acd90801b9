#!/usr/bin/env bash
# scenariogeneration 0.16.7: OpenSCENARIO files that are read with `xosc.ParseOpenScenario`, raised to a newer version with `header.setVersion(minor=...)` if at all, and
# written. Each file here is valid by the schema of its version, which the package checks as it reads.
#
# Expected: the same place, weather and time. OpenSCENARIO gave attributes new names where it gave them a new unit or meaning: `latitude` in radians (1.1) is `latitudeDeg`
# in degrees (1.2), `height` above a surface such as the level of the sea is `altitude` above the road, `intensity` of rain from 0 to 1 is `precipitationIntensity` in mm/h.
# Seen, without a word: the number is kept, and the name is changed.
#   1. From 1.1 to 1.2 or 1.3, 49 degrees north, 8.4 east is 0.86 north, 0.15 east, in the Gulf of Guinea, and 120 m above the sea is 120 m above the road. Back from 1.3 to
#      1.1, 49 degrees are 49 radians. `GeoPosition(49, 8.4)` in Python writes "49" for either.
#   2. Rain of intensity 0.8, near the most there is, is 0.8 mm/h, a drizzle. This is so within 1.1 too, which has both names.
#   3. At any version 23:30:15.5-05:00 is 23:30:15 without a zone: half a second and the offset are gone.
# Why it matters: rules apply by weather and light, and a drive is laid on a map by its place. Old scenarios are raised to the version of a new simulator; the result is valid
# too, and each number is one that the new attribute may have.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
python3 -m pip --python venv install -q --no-compile --no-deps scenariogeneration==0.16.7 lxml==6.1.3 numpy==2.4.6 scipy==1.17.1 \
  pyclothoids==0.2.0 pybind11==3.1.0 xmlschema==4.3.2 elementpath==5.1.4

cat >seen.py <<'PY'
import contextlib
import io
import math
import sys
import warnings
import xml.etree.ElementTree as ET

from scenariogeneration import xosc

LATITUDE, LONGITUDE = 49.0, 8.4
RADIANS = f'<GeoPosition latitude="{math.radians(LATITUDE)}" longitude="{math.radians(LONGITUDE)}" height="120"/>'
DEGREES = f'<GeoPosition latitudeDeg="{LATITUDE}" longitudeDeg="{LONGITUDE}" altitude="0"/>'
BOX = '<BoundingBox><Center x="1.4" y="0" z="0.7"/><Dimensions width="2" length="5" height="1.5"/></BoundingBox>'
LIMITS = '<Performance maxSpeed="50" maxAcceleration="5" maxDeceleration="9"/>'
WHEELS = 'wheelDiameter="0.6" trackWidth="1.8" positionZ="0.3"'
AXLES = f'<Axles><FrontAxle maxSteering="0.5" positionX="3.1" {WHEELS}/><RearAxle maxSteering="0" positionX="0" {WHEELS}/></Axles>'


def scenario(minor, place, rain='precipitationIntensity="4"', time="2026-11-01T12:00:00"):
    """A scenario of one car that stands in a place, in the rain."""
    sun = "illuminance" if minor >= 2 else "intensity"
    weather = f'<Weather><Sun {sun}="1000" azimuth="0" elevation="1"/><Fog visualRange="1000"/><Precipitation precipitationType="rain" {rain}/></Weather>'
    day = f'<TimeOfDay animation="false" dateTime="{time}"/>'
    environment = f'<Environment name="day">{day}{weather}<RoadCondition frictionScaleFactor="1"/></Environment>'
    car = f'<Vehicle name="car" vehicleCategory="car"><ParameterDeclarations/>{BOX}{LIMITS}{AXLES}<Properties/></Vehicle>'
    stand = f'<Private entityRef="Ego"><PrivateAction><TeleportAction><Position>{place}</Position></TeleportAction></PrivateAction></Private>'
    group = '<ManeuverGroup name="none" maximumExecutionCount="1"><Actors selectTriggeringEntities="false"/></ManeuverGroup>'
    return (
        f'<?xml version="1.0"?><OpenSCENARIO><FileHeader revMajor="1" revMinor="{minor}" date="2026-11-01T12:00:00" description="rain" author="nobody"/>'
        f'<ParameterDeclarations/><CatalogLocations/><RoadNetwork/><Entities><ScenarioObject name="Ego">{car}</ScenarioObject></Entities>'
        f"<Storyboard><Init><Actions><GlobalAction><EnvironmentAction>{environment}</EnvironmentAction></GlobalAction>{stand}</Actions></Init>"
        f'<Story name="none"><Act name="none">{group}<StartTrigger/></Act></Story><StopTrigger/></Storyboard></OpenSCENARIO>'
    )


def through(text, minor=None):
    """The attributes of place, rain and time after the way through the package, and how many warnings the way there and the written file call forth."""
    with open("before.xosc", "w") as file:
        file.write(text)
    with warnings.catch_warnings(record=True) as said, contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("always")
        read = xosc.ParseOpenScenario("before.xosc")
        if minor is not None:
            read.header.setVersion(minor=minor)
        read.write_xml("after.xosc")
        xosc.ParseOpenScenario("after.xosc")
    written = ET.parse("after.xosc")
    place, rain, time = (written.find(f".//{tag}").attrib for tag in ("GeoPosition", "Precipitation", "TimeOfDay"))
    return dict(place), dict(rain), time["dateTime"], len(said)


def show(title, attributes):
    print(f"{title:34}", ", ".join(f"{name} {value}" for name, value in attributes.items()))


same = True
for minor in (None, 2, 3):
    place, *_, said = through(scenario(1, RADIANS), minor)
    show(f"place of 1.1 in 1.{minor or 1}, warnings {said}", place)
    names = ("latitude", "longitude", "height") if minor is None else ("latitudeDeg", "longitudeDeg", "altitude")
    numbers = [round(float(place[name]), 4) for name in names]
    same &= numbers == [0.8552, 0.1466, 120.0] and said == 0
place, *_, said = through(scenario(3, DEGREES), 1)
show(f"place of 1.3 in 1.1, warnings {said}", place)
same &= (place["latitude"], place["longitude"], said) == ("49.0", "8.4", 0)

for minor in (None, 2):
    _, rain, _, said = through(scenario(1, RADIANS, rain='intensity="0.8"'), minor)
    show(f"rain 0.8 of 1.1 in 1.{minor or 1}, warnings {said}", rain)
    same &= "intensity" not in rain and rain["precipitationIntensity"] == "0.8" and said == 0

_, _, time, said = through(scenario(3, DEGREES, time="2026-11-01T23:30:15.500-05:00"))
print(f"23:30:15.500-05:00 of 1.3 is {time}, warnings {said}")
same &= (time, said) == ("2026-11-01T23:30:15", 0)
sys.exit(0 if same else "changed: places, rain and times of scenarios")
PY
venv/bin/python seen.py
