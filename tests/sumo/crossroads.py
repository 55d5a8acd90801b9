"""A crossroads in SUMO whose lanes are shared by turns with lights of their own, and some who run the red ones.

SUMO writes one head for each way through the junction (OpenDRIVE 1000011 with arrows); its own states say who was lawful.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from tests.scenes import verdict_rows
from tests.sumo.world import run

if TYPE_CHECKING:
    from pathlib import Path

ARM_M = 150
END_S = 5
_ARMS = {"w": (-ARM_M, 0), "s": (0, -ARM_M), "e": (ARM_M, 0), "n": (0, ARM_M)}
_STATES = {"g": "green", "G": "green", "y": "amber", "r": "red", "u": "red_amber", "o": "flashing", "O": "off"}
_RULE = "ukhc.r175.red"


class Crossing(NamedTuple):
    """Somebody goes over the end of a lane into the junction, the light for its own turn being so."""

    vehicle: str
    t_s: float
    light: str
    state: str
    turn: str


class Compared(NamedTuple):
    """Crossings by verdict: those that SUMO's states allow, those on red, and of the lawful ones those that turn."""

    lawful: Counter[str]
    on_red: Counter[str]
    lawful_turns: Counter[str]


def simulate(folder: Path, *, seconds: int, seed: int = 1) -> None:
    """Drive so many seconds of traffic, 10 Hz, into `folder`. The same seed gives the same log."""
    folder.mkdir(parents=True, exist_ok=True)
    nodes = "".join(f'<node id="{a}" x="{x}" y="{y}"/>' for a, (x, y) in _ARMS.items())
    edges = "".join(
        f'<edge id="{a}" from="{start}" to="{end}" numLanes="2" speed="13.9"/>'
        for arm in _ARMS
        for a, start, end in ((f"{arm}in", arm, "c"), (f"{arm}out", "c", arm))
    )
    (folder / "c.nod.xml").write_text(f'<nodes><node id="c" x="0" y="0" type="traffic_light"/>{nodes}</nodes>')
    (folder / "c.edg.xml").write_text(f"<edges>{edges}</edges>")
    made = (
        "--node-files",
        "c.nod.xml",
        "--edge-files",
        "c.edg.xml",
        "--offset.disable-normalization",
        "--no-turnarounds",
    )
    run("netconvert", *made, "--output-file", "c.net.xml", "--opendrive-output", "c.xodr", cwd=folder)
    (folder / "c.add.xml").write_text(_lights(folder))
    (folder / "c.rou.xml").write_text(_routes(seconds))
    run(
        "sumo", "--net-file", "c.net.xml", "--route-files", "c.rou.xml", "--additional-files", "c.add.xml", "--step-length", "0.1",
        "--end", str(seconds), "--seed", str(seed), "--collision.action", "warn", "--precision", "4", "--no-step-log",
        "--fcd-output", "c.fcd.xml", "--time-to-teleport", "-1", cwd=folder,
    )  # fmt: skip


def _read(file: Path) -> ET.Element:
    return ET.parse(file).getroot()  # noqa: S314


def _links(folder: Path) -> dict[str, tuple[int, str, str]]:
    """Return the first lane of each way through -> (number of its light, road that it comes from, turn)."""
    net = _read(folder / "c.net.xml")
    return {
        k.attrib["via"]: (int(k.attrib["linkIndex"]), k.attrib["from"], k.attrib["dir"].lower())
        for k in net.iterfind("connection")
        if k.get("tl")
    }


def _lights(folder: Path) -> str:
    """Return a programme of four phases: straight on and right of both arms that face each other, then their left turns."""
    links = sorted(_links(folder).values())
    phases = []
    for arms in (("win", "ein"), ("sin", "nin")):
        for turns in ("sr", "l"):
            for state, lasts in (("G", 12), ("y", 3), ("r", 2)):
                shown = "".join(state if road in arms and turn in turns else "r" for _, road, turn in links)
                phases.append(f'<phase duration="{lasts}" state="{shown}"/>')
    saved = '<timedEvent type="SaveTLSStates" source="c" dest="c.tls.xml"/>'
    return f'<additional><tlLogic id="c" type="static" programID="own" offset="0">{"".join(phases)}</tlLogic>{saved}</additional>'


def _routes(seconds: int) -> str:
    runs = 'jmDriveAfterRedTime="1000" jmDriveRedSpeed="8" jmIgnoreFoeProb="1" jmIgnoreFoeSpeed="100"'
    types = f'<vType id="lawful"/><vType id="runner" {runs}/>'
    flows = [
        f'<flow id="{kind}-{a}{b}" type="{kind}" from="{a}in" to="{b}out" begin="0" end="{seconds}" period="exp({rate})"'
        ' departSpeed="max" departLane="best"/>'
        for a in _ARMS
        for b in _ARMS
        if a != b
        for kind, rate in (("lawful", 1 / 60), ("runner", 1 / 240))
    ]
    return f"<routes>{types}{''.join(flows)}</routes>"


def crossings(folder: Path) -> list[Crossing]:
    """Return who went into the junction and what SUMO's light for that way showed.

    Not where it changed just then, nor in the last seconds, in which the log does not show the turn to its end.
    """
    links, found = _links(folder), []
    shown = {
        round(float(s.attrib["time"]) * 10): s.attrib["state"] for s in _read(folder / "c.tls.xml").iterfind("tlsState")
    }
    before: dict[str, str] = {}
    for step in _read(folder / "c.fcd.xml")[: -10 * END_S]:
        k = round(float(step.attrib["time"]) * 10)
        for vehicle in step.iterfind("vehicle"):
            name, lane = vehicle.attrib["id"], vehicle.attrib["lane"]
            if lane in links and before.get(name) != lane:
                light, _, turn = links[lane]
                states = {shown[k + i][light] for i in (-2, -1, 0, 1) if k + i in shown}
                if len(states) == 1:
                    found.append(Crossing(name, k / 10, f"c_{light}", _STATES[states.pop()], turn))
            before[name] = lane
    return found


def crossroads_drive(folder: Path, road: str) -> Drive:
    """Return the log, every vehicle an ego, with the lights' states beside it, on the map `road`: c.xodr or c.net.xml.

    In Great Britain nobody turns on red; where the nation is not known, a right turn may be allowed.
    """
    trace = read_trace(
        folder / "c.fcd.xml",
        IngestOptions(ego="all", mapping=str(folder / "c.rou.xml"), conditions=(("nation", "gb"),)),
    )
    return Drive(trace, load_map(MapSource(road, (folder / road).read_bytes())))


def compared(folder: Path, road: str) -> Compared:
    """Hold the verdicts on red lights against SUMO's own states."""
    verdicts: dict[str, list[str]] = {}
    for row in verdict_rows([crossroads_drive(folder, road)], rules=(_RULE,)):
        if row["t_ref_ns"] is not None:
            # SUMO moves who stands into the next lane at once: from there on the vehicle is "id#2"
            verdicts.setdefault(row["ego_id"].partition("#")[0], []).append(row["verdict"])
    counts = Compared(Counter(), Counter(), Counter())
    for c in crossings(folder):
        said = verdicts.get(c.vehicle, [])  # nobody comes twice
        word = said[0] if len(said) == 1 else f"{len(said)} verdicts"
        (counts.on_red if c.state == "red" else counts.lawful)[word] += 1
        if c.state != "red" and c.turn != "s":
            counts.lawful_turns[word] += 1
    return counts
