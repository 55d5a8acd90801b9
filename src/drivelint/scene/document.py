"""Reads a file of scenes: YAML with roads by name, and scenes that name one of them.

The whole vocabulary is here; `drivelint docs scenes` explains it. Scenes are drawn as if the right were driven on, with x to the east and
y to the north; where the left is driven on, the drawing is mirrored.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import yaml

from drivelint.casefile import WordLoader
from drivelint.errors import UsageError
from drivelint.phrases import hint
from drivelint.scene.strange_words import problems

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

Side = Literal["left", "right"]
Arm = Literal["west", "north", "east", "south"]
Numbers = list[float]
Knots = float | list[Annotated[Numbers, msgspec.Meta(min_length=2, max_length=2)]]
"""A number that holds throughout, or [second, number] pairs."""
Spans = list[Annotated[Numbers, msgspec.Meta(min_length=2, max_length=2)]]
"""[first, last] second of each."""


class _Part(
    msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True, rename=lambda name: name.rstrip("_")
):
    """A mapping of the document: it has the keys of its fields and no others."""


class LaneText(_Part, frozen=True):
    """A lane in full; most are written as one text: kind, width and outer mark."""

    kind: str = "driving"
    width: float = 3.5
    mark: str | list[tuple[float, str]] | None = None
    """Of its outer border, from stations of the road on; None: solid at the edge of what is driven on, else broken."""
    from_: float = 0.0
    to: float | None = None
    """Where along the road it is there; None: to the end."""


class Thing(_Part, frozen=True):
    """A thing at or on a road: a light, a stop line, a crossing, or a sign."""

    kind: str = msgspec.field(name="what")
    """light NAME, stop line, zebra, signalled crossing, crossing, sign COUNTRY CODE, or sign NAME."""
    at: float
    off: float = 0.0
    """Metres to the left of the road's line, as drawn."""
    facing: Literal["along", "against", "both"] = "along"
    lanes: list[int] | None = None
    width: float | None = None
    deep: float = 3.0


class RoadText(_Part, frozen=True):
    """A road: a line, and lanes on both sides of it."""

    line: list[float | Numbers] = msgspec.field(default_factory=lambda: [1000.0])
    """Pieces: metres of a straight, or [metres, radius]; a positive radius turns left, as drawn."""
    start: Numbers | None = None
    """x, y and heading in degrees of its start; none: as its neighbour's end says, else the origin, to the east."""
    after: str | None = None
    """The road that it continues, lane by lane."""
    kind: str = "rural"
    limit: str | list[tuple[float, str]] | None = "60 mph"
    lanes: list[str | LaneText] = msgspec.field(default_factory=lambda: ["driving 3.5"])
    """Those that run along the line, from the middle outwards: lanes 1, 2, ..."""
    against: list[str | LaneText] = msgspec.field(default_factory=lambda: ["driving 3.5"])
    """Those that run against it, from the middle outwards: lanes -1, -2, ..."""
    middle: str | list[tuple[float, str]] = "broken"
    height: Knots = 0.0
    """Metres, or [station, metres] pairs, straight between them."""
    things: list[Thing] = []


class Crossing(_Part, frozen=True):
    """Arms of one kind that lead away from a junction, to compass points."""

    arms: tuple[Arm, ...] = ("west", "north", "east", "south")
    half: float = 12.0
    """From the middle of the junction to where the arms begin, in metres."""
    road: RoadText = RoadText(line=[200.0], kind="town", limit="30 mph")
    things: dict[str, list[Thing]] = {}
    """Arm -> the things that only it has."""


class Roundabout(_Part, frozen=True):
    """A ring with arms to compass points."""

    arms: tuple[Arm, ...] = ("west", "north", "east", "south")
    radius: float = 20.0
    """Of the middle of the ring's lane."""
    road: RoadText = RoadText(line=[150.0], kind="town", limit="30 mph")


class Layout(_Part, frozen=True):
    """Roads that belong together, and how one gets from one to another."""

    traffic: Side | Literal["both"] = "right"
    roads: dict[str, RoadText] = {}
    crossing: Crossing | None = None
    roundabout: Roundabout | None = None
    turns: Literal["all"] | list[str] = []
    """Lanes that a junction joins, as `west -1 > north 1`; all: every lane that ends where others begin."""


class Step(_Part, frozen=True):
    """A step of an actor from a time or place on, instead of knots."""

    at: float | None = None
    """Second."""
    place: float | None = None
    """Metre along its way."""
    speed: float | None = None
    by: float = 2.0
    """Acceleration or braking up to that speed, m/s2."""
    stop: float | None = None
    """Metre along its way where its front comes to stand, braking with `by`."""
    lane: int | None = None
    """The number of the lane beside, of the road that it is on."""
    offset: float | None = None
    over: float = 4.0
    """Seconds that a change of lane or offset takes."""
    indicator: str | None = None


class Faults(_Part, frozen=True):
    """The faults of the recorder in the samples of one actor."""

    jitter: float = 0.0
    """Standard deviation of places, and of speeds in m/s; always the same draw."""
    lost_spans: Spans = msgspec.field(default_factory=list, name="lost")
    turned: Spans = []
    """The heading is the wrong way round."""
    frozen: Spans = []
    """The place stays, the speed goes on."""
    swapped: bool = False
    """Length and width are exchanged."""
    shift: list[Numbers] = []
    """[first second, last second, metres ahead, metres to the left]: the place jumps."""
    unknown: list[Literal["speed", "heading", "size", "width", "class"]] = []


class ActorText(_Part, frozen=True):
    """An actor and its motion. One of `lane`, `route`, `path`, `track` and `place` says where."""

    kind: str | None = "car"
    size: list[float | None] | None = None
    """Length, width and height; none: those usual for its kind."""
    lane: str | None = None
    """A road and the number of a lane: `main 1`."""
    route: list[str] = []
    """Lanes one after another; the way through a junction is found."""
    path: list[Numbers] = []
    """Points x, y that it walks past in straight lines."""
    track: list[Numbers] = []
    """Second, x and y, smooth between."""
    place: Numbers | None = None
    """x, y and heading in degrees of one that stands."""
    from_: float = 0.0
    """Metres along its way at second 0, of the middle of its box."""
    speed: Knots = 0.0
    """m/s; between knots it changes evenly."""
    offset: Knots = 0.0
    """Metres to the left of its way as drawn, which is the side to overtake on; between knots it changes smoothly."""
    do: list[Step] = []
    facing: Literal["ahead", "back"] = "ahead"
    """back: it is turned round, and what moves goes backwards."""
    heading: Knots | None = None
    """Degrees, anticlockwise from the east as drawn, for an actor whose heading does not follow from its motion."""
    indicator: str | list[tuple[float, str]] = "off"
    """off, left, right, hazard or unknown, as drawn: left is the side to overtake on."""
    brake: str | list[tuple[float, str]] | None = None
    """off, on, strong or unknown; none: as it brakes."""
    height: float | None = None
    """Of the ground under it, metres; none: of the road that it is on."""
    there: list[float] | None = None
    """First and last second in the log."""
    faults: Faults = Faults()


class SceneText(_Part, frozen=True, kw_only=True):
    """A scene and the verdicts of a careful examiner."""

    name: str
    summary: str = msgspec.field(name="what")
    roads: str
    traffic: Side | None = None
    """Instead of the value of the layout."""
    seconds: float = 20.0
    rate: float = 10.0
    conditions: dict[str, str] = msgspec.field(default_factory=dict, name="given")
    """Conditions; dry weather and daylight are given unless it says otherwise, or `unknown`."""
    lights: dict[str, list[tuple[float, str]]] = {}
    says: list[list[float | str | None]] = []
    """[second, event] or [second, event, value] that the ego declares."""
    actors: dict[str, ActorText]
    expect: dict[str, str]
    """Rule -> verdict, a reason code in brackets, and why: `unknown (no_width): the log has no width`."""
    line: int = 0
    """Its line in the file: filled in, never written."""


class SceneFile(_Part, frozen=True):
    """All of a file."""

    roads_from: list[str] = []
    """Files beside it, for their roads."""
    all_fails: bool = False
    """Every fail of a stable critical or major rule is listed, and another is a fault."""
    roads: dict[str, Layout] = {}
    scenes: list[SceneText] = []


def read(path: Path) -> SceneFile:
    """Read a file of scenes, and the roads of the files that it names. Errors: `UsageError` with file and line."""
    scene_file = _parsed(path)
    roads: dict[str, Layout] = {}
    for name in scene_file.roads_from:
        roads |= _parsed(path.parent / name).roads
    scene_file = msgspec.structs.replace(scene_file, roads=roads | scene_file.roads)
    names: dict[str, int] = {}
    for scene in scene_file.scenes:
        if scene.name in names:
            raise UsageError(
                f"{path}:{scene.line}: scene {scene.name!r} has the name of that in line {names[scene.name]}"
            )
        if scene.roads not in scene_file.roads:
            raise UsageError(f"{path}:{scene.line}: no roads {scene.roads!r}: {hint(scene.roads, scene_file.roads)}")
        names[scene.name] = scene.line
    return scene_file


def _parsed(path: Path) -> SceneFile:
    try:
        loader = WordLoader(path.read_text(encoding="utf-8"))
        root = loader.get_single_node()
        raw = loader.construct_document(root) if root else None
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: cannot be read: {error}") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise UsageError(f"{path}:{mark.line + 1 if mark else 1}: not YAML: {' '.join(str(error).split())}") from error
    if not isinstance(raw, dict):
        raise UsageError(f"{path}:1: a file of scenes has the keys roads and scenes")
    for line, part in _parts_with_lines(raw, root):
        for problem in problems(part, SceneFile):
            raise UsageError(f"{path}:{line}: {problem}")
    try:
        return msgspec.convert(raw, SceneFile, strict=True)
    except msgspec.ValidationError as error:
        raise UsageError(f"{path}:{_line_of(str(error), root)}: {error}") from error


def _parts_with_lines(raw: dict[str, Any], root: Any) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the parts of a document with their lines, and give each scene its line."""
    for key_node, node in root.value:
        key, value = str(key_node.value), raw[str(key_node.value)]
        if key == "scenes" and isinstance(value, list):
            for scene, scene_node in zip(value, node.value, strict=True):
                line = scene_node.start_mark.line + 1
                if isinstance(scene, dict):
                    scene["line"] = line
                yield line, {key: [scene]}
        elif key == "roads" and isinstance(value, dict):
            for (name, layout), (name_node, _) in zip(value.items(), node.value, strict=True):
                yield name_node.start_mark.line + 1, {key: {name: layout}}
        else:
            yield key_node.start_mark.line + 1, {key: value}


def _line_of(message: str, root: Any) -> int:
    """Return the line of the scene that a message of msgspec is about: `... at `$.scenes[3].actors`."""
    number = re.search(r"\$\.scenes\[(\d+)\]", message)
    nodes: Any = next((node.value for key, node in root.value if key.value == "scenes"), [])
    return int(nodes[int(number[1])].start_mark.line) + 1 if number else 1
