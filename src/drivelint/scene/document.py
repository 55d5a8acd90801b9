"""Reads a file of scenes: YAML with named layouts of roads, and scenes, each of which names a layout.

The types define all keys and words; `drivelint docs scenes` explains them. Scenes are drawn for right-hand traffic, with x to the east and
y to the north; for left-hand traffic, the drawing is mirrored.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import yaml

from drivelint.casefile.case_list import OnOffAsTextLoader
from drivelint.errors import SceneFileError, UsageError
from drivelint.phrases import hint
from drivelint.scene.strange_words import problems

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

Side = Literal["left", "right"]
Arm = Literal["west", "north", "east", "south"]
Numbers = list[float]
Pair = Annotated[Numbers, msgspec.Meta(min_length=2, max_length=2)]
Triple = Annotated[Numbers, msgspec.Meta(min_length=3, max_length=3)]
Knots = float | Annotated[list[Pair], msgspec.Meta(min_length=1)]
"""A constant number, or [second, number] pairs."""
Spans = list[Pair]
"""[first second, last second] of each span."""


class _StrictMapping(
    msgspec.Struct, forbid_unknown_fields=True, frozen=True, kw_only=True, rename=lambda name: name.rstrip("_")
):
    """A mapping of the document; only the names of its fields are allowed as keys."""


class LaneEntry(_StrictMapping, frozen=True):
    """A lane as a mapping. Most lanes are written as a text instead: kind, width and outer mark."""

    kind: str = "driving"
    width: float = 3.5
    mark: str | list[tuple[float, str]] | None = None
    """The mark of the outer border, or [station, mark] pairs; None: solid at the edge of the drivable lanes, broken between
    them, and no mark at other lanes."""
    from_: float = 0.0
    to: float | None = None
    """The lane exists from station `from_` to station `to`; None: to the end of the road."""


class RoadThing(_StrictMapping, frozen=True):
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


class RoadEntry(_StrictMapping, frozen=True):
    """A road: a line, and lanes on both sides of it."""

    line: Annotated[list[float | Numbers], msgspec.Meta(min_length=1)] = msgspec.field(default_factory=lambda: [1000.0])
    """Pieces: metres of a straight, or [metres, radius]; a positive radius turns left, as drawn."""
    start: Triple | None = None
    """x, y and heading in degrees of the road's start; None: the end of the road `after`, or else the origin, to the east."""
    after: str | None = None
    """The road that this road continues, lane by lane."""
    kind: str = "rural"
    limit: str | list[tuple[float, str]] | None = "60 mph"
    lanes: list[str | LaneEntry] = msgspec.field(default_factory=lambda: ["driving 3.5"])
    """The lanes along the line, from the middle outwards: lanes 1, 2, ..."""
    against: list[str | LaneEntry] = msgspec.field(default_factory=lambda: ["driving 3.5"])
    """The lanes in the opposite direction, from the middle outwards: lanes -1, -2, ..."""
    middle: str | list[tuple[float, str]] = "broken"
    height: Knots = 0.0
    """Metres, or [station, metres] pairs, linear between them."""
    things: list[RoadThing] = []


class Crossroads(_StrictMapping, frozen=True):
    """A junction whose arms, roads with the same lanes, lead away from it to points of the compass."""

    arms: tuple[Arm, ...] = ("west", "north", "east", "south")
    half: float = 12.0
    """Metres from the middle of the junction to the start of the arms."""
    road: RoadEntry = RoadEntry(line=[200.0], kind="town", limit="30 mph")
    things: dict[str, list[RoadThing]] = {}
    """Arm -> things on this arm alone."""


class Roundabout(_StrictMapping, frozen=True):
    """A ring with arms to points of the compass."""

    arms: tuple[Arm, ...] = ("west", "north", "east", "south")
    radius: float = 20.0
    """The radius of the centre line of the ring's lane, in metres."""
    road: RoadEntry = RoadEntry(line=[150.0], kind="town", limit="30 mph")


class RoadLayout(_StrictMapping, frozen=True):
    """Roads that belong together, and the turns that connect them."""

    traffic: Side | Literal["both"] = "right"
    roads: dict[str, RoadEntry] = {}
    crossing: Crossroads | None = None
    roundabout: Roundabout | None = None
    turns: Literal["all"] | list[str] = []
    """Pairs of lanes that a junction connects, as `west -1 > north 1`; all: each arriving lane with the leaving lanes of other roads."""


class MotionStep(_StrictMapping, frozen=True):
    """A change of an actor's motion that begins at a time or a place. Steps can be written instead of knots."""

    at: float | None = None
    """The second at which the step begins."""
    place: float | None = None
    """The metre along the actor's path at which the step begins."""
    speed: float | None = None
    by: float = 2.0
    """Acceleration or deceleration until `speed` is reached, m/s2."""
    stop: float | None = None
    """The metre along the actor's path at which its front stops, braking with `by`."""
    lane: int | None = None
    """The number of the lane to which the actor changes, on the first road of its path."""
    offset: float | None = None
    over: float = 4.0
    """Seconds that a change of lane or offset takes."""
    indicator: str | None = None


class RecorderFaults(_StrictMapping, frozen=True):
    """The faults of the recorder in the samples of one actor."""

    jitter: float = 0.0
    """Standard deviation of the noise of positions (m) and speeds (m/s); the random numbers are always the same."""
    lost_spans: Spans = msgspec.field(default_factory=list, name="lost")
    turned: Spans = []
    """When the recorded heading is wrong by 180 degrees."""
    frozen: Spans = []
    """When the recorded position stays the same, although the recorded speed continues."""
    swapped: bool = False
    """Length and width are exchanged."""
    shift: list[Annotated[Numbers, msgspec.Meta(min_length=4, max_length=4)]] = []
    """[first second, last second, metres ahead, metres to the left]: the position is shifted."""
    unknown: list[Literal["speed", "heading", "size", "width", "class"]] = []


class ActorEntry(_StrictMapping, frozen=True):
    """An actor and its motion. One of `lane`, `route`, `path`, `track` and `place` defines where the actor is."""

    kind: str | None = "car"
    size: list[float | None] | None = None
    """Length, width and height in metres; None: the usual size of its kind."""
    lane: str | None = None
    """A road and the number of a lane: `main 1`."""
    route: list[str] = []
    """Successive lanes; the turns through junctions are added."""
    path: list[Pair] = []
    """Points [x, y], with straight lines between them."""
    track: list[Triple] = []
    """Points [second, x, y], with smooth motion between them."""
    place: Triple | None = None
    """x, y and heading in degrees of a standing actor."""
    from_: float = 0.0
    """Position of the middle of its box at second 0, in metres along its path."""
    speed: Knots = 0.0
    """m/s; linear between knots."""
    offset: Knots = 0.0
    """Metres to the left of its path as drawn, which is the side to overtake on; smooth between knots."""
    do: list[MotionStep] = []
    facing: Literal["ahead", "back"] = "ahead"
    """back: the actor is turned round, so that it drives backwards if it moves."""
    heading: Knots | None = None
    """Degrees, anticlockwise from the east as drawn, for an actor whose heading does not follow from its motion."""
    indicator: str | list[tuple[float, str]] = "off"
    """off, left, right, hazard or unknown, as drawn: left is the side to overtake on."""
    brake: str | list[tuple[float, str]] | None = None
    """off, on, strong or unknown; None: derived from its deceleration."""
    height: float | None = None
    """Height of the ground under the actor, in metres; None: the height of its road."""
    there: Pair | None = None
    """First and last second of the actor in the log; None: all seconds."""
    faults: RecorderFaults = RecorderFaults()


class SceneEntry(_StrictMapping, frozen=True, kw_only=True):
    """A scene and its expected verdicts."""

    name: str
    summary: str = msgspec.field(name="what")
    roads: str
    traffic: Side | None = None
    """Replaces the value of the layout."""
    seconds: Annotated[float, msgspec.Meta(gt=0)] = 20.0
    rate: Annotated[float, msgspec.Meta(gt=0)] = 10.0
    conditions: dict[str, str] = msgspec.field(default_factory=dict, name="given")
    """Conditions of the drive. Dry weather and daylight are the default; the value `unknown` removes a condition."""
    lights: dict[str, list[tuple[float, str]]] = {}
    says: list[list[float | str | None]] = []
    """Events that the ego declares: [second, event] or [second, event, value]."""
    actors: dict[str, ActorEntry]
    expect: dict[str, str]
    """Rule -> verdict, a reason code in brackets, and why: `unknown (no_width): the log has no width`."""
    line: int = 0
    """The line of the scene in the file; set by the reader, not by an author."""


class SceneFile(_StrictMapping, frozen=True):
    """The content of a file of scenes."""

    roads_from: list[str] = []
    """Files in the same folder whose roads can be used, too."""
    all_fails: bool = False
    """Whether a critical or major fail of a stable rule is an error if it is not expected."""
    roads: dict[str, RoadLayout] = {}
    scenes: list[SceneEntry] = []


def read(path: Path) -> SceneFile:
    """Read a file of scenes, and the roads of the files that it names. Errors: `UsageError` with file and line."""
    scene_file = _parse_scene_file(path)
    roads: dict[str, RoadLayout] = {}
    for name in scene_file.roads_from:
        roads |= _parse_scene_file(path.parent / name).roads
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


def _parse_scene_file(path: Path) -> SceneFile:
    try:
        loader = OnOffAsTextLoader(path.read_text(encoding="utf-8"))
        root = loader.get_single_node()
        raw = loader.construct_document(root) if root else None
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: cannot be read: {error}") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise UsageError(f"{path}:{mark.line + 1 if mark else 1}: not YAML: {' '.join(str(error).split())}") from error
    if not isinstance(raw, dict):
        raise UsageError(f"{path}:1: a file of scenes has the keys roads and scenes")
    _set_lines_of_scenes(raw, root)
    wrong = [(_line_of(root, problem.keys), problem.message) for problem in problems(raw, SceneFile)]
    if wrong:
        raise SceneFileError("\n".join(f"{path}:{line}: {message}" for line, message in sorted(wrong)))
    try:
        return msgspec.convert(raw, SceneFile, strict=True)
    except msgspec.ValidationError as error:
        raise UsageError(f"{path}:{_line_number_of_scene(str(error), root)}: {error}") from error


def _set_lines_of_scenes(raw: dict[str, Any], root: Any) -> None:
    """Set the key `line` of each scene."""
    for key_node, node in root.value:
        value = raw[str(key_node.value)]
        if key_node.value == "scenes" and isinstance(value, list):
            for scene, scene_node in zip(value, node.value, strict=True):
                if isinstance(scene, dict):
                    scene["line"] = scene_node.start_mark.line + 1


def _line_of(root: Any, keys: Sequence[str | int]) -> int:
    """Return the line of the value to which keys and indices lead; if a part is missing, of what would contain it."""
    node, line = root, 1
    for key in keys:
        if isinstance(node, yaml.MappingNode):
            entries = ((key_node, value) for key_node, value in node.value if str(key_node.value) == str(key))
            key_node, node = next(entries, (None, None))
            if key_node is None:  # it comes from a merged mapping
                break
            line = key_node.start_mark.line + 1
        elif isinstance(node, yaml.SequenceNode) and isinstance(key, int):
            node = node.value[key]
            line = node.start_mark.line + 1
    return line


def _line_number_of_scene(message: str, root: Any) -> int:
    """Return the line of the scene that a message of msgspec is about: `... at `$.scenes[3].actors`."""
    number = re.search(r"\$\.scenes\[(\d+)\]", message)
    nodes: Any = next((node.value for key, node in root.value if key.value == "scenes"), [])
    return int(nodes[int(number[1])].start_mark.line) + 1 if number else 1
