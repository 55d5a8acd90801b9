"""The result of `inspect`, with the structure of its JSON; `schemas/inspect.schema.json` is generated from this module.

Times are in seconds; times named `t_...` or `..._at_s` count from the first time stamp of the log. Lengths are in metres.
"""

from __future__ import annotations

from typing import Annotated, Final, Literal

import msgspec
from msgspec import Meta

INSPECT_SCHEMA_VERSION: Final = 1
"""Version of the JSON: raised when a key changes its meaning or is removed, but not for new keys."""


def key_description(meaning: str) -> Meta:
    """Return metadata with the description of a key, for the schema."""
    return Meta(description=meaning)


class File(msgspec.Struct, frozen=True, kw_only=True):
    """The log as a file."""

    name: Annotated[str, key_description("file or folder name, without where it lies")]
    bytes: Annotated[int, key_description("size; of a folder, of its tables together")]
    sha256: Annotated[str | None, key_description("hash of its content; null: not read as a drive")] = None
    drive_id: Annotated[str | None, key_description("its id in the verdicts; null: not read as a drive")] = None
    format: Annotated[
        str | None, key_description("osi-mcap, canonical-parquet or the mapping's name; null: not read")
    ] = None


class Channel(msgspec.Struct, frozen=True, kw_only=True):
    """One channel of an MCAP file."""

    topic: str
    schema: Annotated[str | None, key_description("name of the messages' schema")]
    schema_encoding: Annotated[str | None, key_description("protobuf, ros2msg, jsonschema, ...")]
    encoding: Annotated[str, key_description("of the messages: protobuf, cdr, json, ...")]
    messages: int
    bytes: Annotated[int, key_description("of all its messages, unpacked")]
    rate_hz: Annotated[float | None, key_description("mean, by log time; null: fewer than two messages")]
    read_as: Annotated[str | None, key_description("ground truth, map, declared events, pictures; null: not read")]


class Column(msgspec.Struct, frozen=True, kw_only=True):
    """One column of a table. In a wide table, one entry stands for the column in all groups, with `{k}` for the group's number."""

    name: str
    read_as: Annotated[
        list[str], key_description("the quantity that the mapping reads from it: time, x, yaw, class, ...; empty: none")
    ]
    unit: Annotated[str | None, key_description("as the mapping says; null: SI, or no number")] = None


class Sheet(msgspec.Struct, frozen=True, kw_only=True):
    """One table of the log."""

    name: Annotated[str, key_description("file name")]
    rows: Annotated[int | None, key_description("null: not counted")]
    columns: list[Column]


class Content(msgspec.Struct, frozen=True, kw_only=True):
    """The content of the file."""

    channels: Annotated[list[Channel], key_description("of an MCAP file, by topic")] = []
    sheets: Annotated[list[Sheet], key_description("tables, of CSV and Parquet")] = []
    mapping: Annotated[str | None, key_description("the mapping that a table was read through")] = None
    notes: Annotated[list[str], key_description("the notes of the reader")] = []
    draft_mapping: Annotated[
        str | None,
        key_description("where no mapping fits a table: one to start from, TOML, guessed from the columns' names"),
    ] = None


class Clock(msgspec.Struct, frozen=True, kw_only=True):
    """The log's time stamps."""

    start_ns: Annotated[int, key_description("the first, on the log's own clock")]
    utc_start: Annotated[str | None, key_description("the same in UTC, ISO 8601; null: the log does not say")]
    duration_s: Annotated[float, key_description("from the first to the last")]
    steps: Annotated[int, key_description("distinct time stamps")]
    period_s: Annotated[float | None, key_description("median time between them; null: there is only one")]
    holes: Annotated[int, key_description("gaps of more than 2.5 periods, across which nothing is judged")]
    longest_hole_s: float | None = None
    first_hole_at_s: float | None = None


class ClassCount(msgspec.Struct, frozen=True, kw_only=True):
    """Actors of one class."""

    actor_class: Annotated[str | None, key_description("null: not known")]
    n: int
    sized: Annotated[int, key_description("of them with a known length and width")]
    moving: Annotated[int, key_description("of them those that moved by more than 1 m")]


class Actor(msgspec.Struct, frozen=True, kw_only=True):
    """One actor and its track."""

    actor_id: str
    actor_class: Annotated[str | None, key_description("null: not known")]
    length_m: float | None
    width_m: float | None
    states: int
    first_at_s: float
    last_at_s: float
    way_m: Annotated[float, key_description("length of its track")]
    top_speed_mps: Annotated[float | None, key_description("null: no speed is known")]


class MapRegistration(msgspec.Struct, frozen=True, kw_only=True):
    """The fit of an ego's track to the map."""

    ok: Annotated[bool, key_description("good enough for rules that need the map")]
    reason: str
    steps: Annotated[int, key_description("steps with a position")]
    on_lane: Annotated[int, key_description("of them, on a lane for driving")]
    moving: Annotated[int, key_description("of those, in motion and not overtaking in an opposing lane")]
    with_direction: Annotated[int, key_description("of the moving ones, along the lane's direction")]
    lateral_median_m: Annotated[
        float | None, key_description("median distance from the lane's middle; null: never on one")
    ]
    aside: Annotated[bool, key_description("the distance is so large that the map may be moved relative to the log")]


class Undecided(msgspec.Struct, frozen=True, kw_only=True):
    """A rule that cannot be decided, or that can fail but not pass."""

    rule_id: str
    title: str
    missing_signals: Annotated[
        list[str], key_description("signals and conditions; without a map only `map` for all that is of the map")
    ] = msgspec.field(name="missing")
    breach_only: Annotated[bool, key_description("the rule can fail, but not pass")] = False


class MissingSignal(msgspec.Struct, frozen=True, kw_only=True):
    """A signal that a rule requires, but that neither the log nor the map provides."""

    signal: str
    reason: Annotated[str, key_description("what is wrong or missing")]
    provide: Annotated[str, key_description("what to provide")]
    rules: Annotated[list[str], key_description("rules that need it")]
    alone: Annotated[list[str], key_description("of them, rules that need nothing else")]


class Ego(msgspec.Struct, frozen=True, kw_only=True):
    """A vehicle under test, and the rules that can be decided for it."""

    actor: Actor
    km: float
    steps: int
    registration: MapRegistration | None
    can: Annotated[list[str], key_description("rules that can be decided")]
    cannot: list[Undecided]
    missing_signals: list[MissingSignal] = msgspec.field(name="missing")


class Road(msgspec.Struct, frozen=True, kw_only=True):
    """The map."""

    name: str
    source: Literal["option", "log"]
    environment_id: str
    sha256: str
    format: str
    offset_m: Annotated[tuple[float, float], key_description("added to its coordinates")]
    handedness: Literal["lht", "rht"]
    handedness_source: Annotated[str, key_description("option, attribute, junctions, traces, default (a guess)")]
    lanelets: int
    drivable: Annotated[int, key_description("lanelets for motor vehicles")]
    drivable_km: float


class Quality(msgspec.Struct, frozen=True, kw_only=True):
    """A data-quality finding."""

    about: Literal["log", "map"]
    severity: Literal["error", "warning", "info"]
    check_id: str
    message: str
    n: int
    actor_id: Annotated[str | None, key_description("null: the whole log, or several actors")] = None
    first_at_s: float | None = None


class Drive(msgspec.Struct, frozen=True, kw_only=True):
    """The log, read as a drive."""

    clock: Clock
    states: int
    classes: Annotated[list[ClassCount], key_description("the most numerous first")]
    egos: Annotated[list[Ego], key_description("by id; empty: the log names none and none was chosen")]
    ego_source: Annotated[str, key_description("how the egos were found, or why there is none")]
    candidates: Annotated[list[Actor], key_description("if there is no ego: the candidates, the longest path first")]
    supposed: Annotated[
        Ego | None, key_description("if there is no ego: what could be decided for the first candidate")
    ]
    road: Annotated[Road | None, key_description("null: no map")]
    road_problem: Annotated[str | None, key_description("why a map that was given is not used")]
    quality: Annotated[list[Quality], key_description("errors first")]
    rules: Annotated[list[str], key_description("the requested rules")]
    selection: Annotated[list[str], key_description("as they were selected")]
    drafts: Annotated[
        list[str], key_description("of them, rules that check runs only if --rules names them; empty: it did")
    ] = []


class Inspection(msgspec.Struct, frozen=True, kw_only=True):
    """Everything that `drivelint inspect --format json` prints."""

    inspect_schema: Annotated[int, key_description("version of this structure")] = INSPECT_SCHEMA_VERSION
    file: File
    content: Content
    problem: Annotated[str | None, key_description("why the file cannot be read as a drive; null: it can")] = None
    drive: Annotated[Drive | None, key_description("null: it cannot be read as one")] = None


def json_schema() -> bytes:
    """Return the JSON schema of an `Inspection`, formatted."""
    raw = msgspec.json.encode(msgspec.json.schema(Inspection), order="sorted")
    return msgspec.json.format(raw, indent=2) + b"\n"
