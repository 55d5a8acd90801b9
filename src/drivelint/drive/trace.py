"""Defines the types that reading a log uses: options, states, recordings, findings and traces."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path  # noqa: TC003 - msgspec reads it
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from drivelint.drive import conditions
from drivelint.phrases import name_list
from drivelint.sql.words import Quantity, words_of_vocabulary

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import pyarrow as pa
    from numpy.typing import NDArray

    from drivelint.arrays import Codes, Floats, Indices, Mask, Times
    from drivelint.drive.outlines.shapes import Outline

Severity = Literal["info", "warning", "error"]

STATE_COLUMNS = ("x_m", "y_m", "z_m", "yaw_rad", "vx_mps", "vy_mps", "ax_mps2", "ay_mps2")
"""The columns of `actor_state` with real numbers, in the order of that table."""
SIZE_COLUMNS = ("length_m", "width_m", "height_m")
"""The columns of `actor` with real numbers, in the order of that table."""
INDICATORS = words_of_vocabulary("indicator")
BRAKE_LIGHTS = words_of_vocabulary("brake_light")
ACTOR_CLASSES = words_of_vocabulary("actor_class")
MOTOR_VEHICLES = ("car", "van", "truck", "bus", "motorcycle", "vehicle")
"""The classes of the actors that `--ego all` judges: vehicles with an engine and a driver."""
EARLIEST_UTC_NS = 946_684_800_000_000_000
"""2000-01-01 UTC. Later times count from 1970 in UTC, smaller times from the start of the recording."""
SIGNAL_STATES = words_of_vocabulary("light_state")


@dataclass(frozen=True)
class Identity:
    """Name and hash of a drive."""

    drive_id: str
    file_name: str
    sha256: str


class EgoSize(NamedTuple):
    """The user's size (m) for an ego without a size in the log; `forward_m`: how far the box centre is ahead of the odometry's origin."""

    length_m: float
    width_m: float
    forward_m: float = 0.0


ASSUMED_MOTION_CHECK = "assumed_motion"
"""The id of the check for a log whose mapping assumes speeds and lanes."""
LOG_TIME_CHECK = "log_time_used"
"""The data-quality check of a log whose states have the log times of their messages, not the messages' own times."""
ASSUMED_SIZE_CHECK = "assumed_size"
"""The id of the check (information only) for a size that the log does not record. Converted logs and clips keep its findings."""
TURNED_FRAME_CHECK = "turned_frame"
"""The id of the check (information only) for a left-handed log, which the mapping converts to a right-handed frame."""
OWN_MAP_UNUSABLE_CHECK = "own_map_unusable"
NOT_IN_FOLDER_CHECK = "map_not_in_folder"
"""Ids of the checks for a log's own map that is unusable, and for a log without a map in the folder. Rules that need a map are then
unknown, with the finding as reason."""
ASIDE_OF_LANE_CHECK = "aside_of_lane"
"""The id of the check for a drive whose ego fits the map, but is far from the middle of its lane."""
EGO_ABSENT_CHECK = "ego_absent"
"""The id of the check for a log that continues while its ego has no position."""
CHECKS_REPEATED_AT_READING = frozenset({
    "acceleration_not_recorded", "aligned", "begin_overlap", "class_implausible", "clock_restart", "common_jolt",
    "duplicate_state", EGO_ABSENT_CHECK, "false_entry", "gap", "heading_spin", "heading_turned", "heading_unknown", "held_track",
    "jumps_onto", "length_below_width", "motion_unknown", "no_position", "no_size", "no_yaw", "position_step", "removed",
    "same_body", "size_implausible", "teleport", "too_fast", "track_gap", "track_parted", "velocity_derived",
    "velocity_end_derived", "velocity_filtered", "velocity_jolt", "velocity_mismatch", "velocity_unknown", "yaw_mismatch",
})  # fmt: skip
"""Ids of the checks of the states. Logs converted `as_recorded` do not keep their findings: reading finds them again."""
LOSS_CHECKS = ("dropped_row", "malformed_row")
"""Ids of checks whose findings, whatever their severity, mean that a part of the log could not be read and is not judged.

An error of any other check means the same."""


@dataclass(frozen=True)
class IngestOptions:
    """Options of the command line about reading a log; None: the log or the mapping decides.

    `need_ego`: whether a log without an ego is an error. `inspect` and `convert` also read logs without an ego.
    """

    mapping: str | None = None
    ego: str | None = None
    topic: str | None = None
    sensor_range_m: float | None = None
    need_ego: bool = True
    conditions: tuple[tuple[str, str], ...] = ()
    """The conditions of the drive, as (condition, word): see `drivelint.drive.conditions`."""
    ego_size: EgoSize | None = None
    in_sight: bool = False
    """Whether actors that are not recorded for a while are assumed to be out of the recorder's line of sight."""
    as_recorded: bool = False
    """Keep the states as the log has them: no doubtful value is made unknown, and no value is derived."""
    map: Path | None = None
    """The map that the user gives: a log in degrees needs the map's projection."""


@dataclass(frozen=True, kw_only=True)
class DriveInput:
    """The options, common to all commands, on how a log is read and which map it is judged on."""

    map: Path | None = None
    map_dir: Path | None = None
    map_offset: tuple[float, float] | None = None
    map_origin: tuple[float, float] | None = None
    handedness: str = "auto"
    mapping: str | None = None
    topic: str | None = None
    ego: str | None = None
    sensor_range_m: float | None = None
    visibility: str = "line-of-sight"
    ego_size: EgoSize | None = None
    env: tuple[str, ...] = ()

    def ingest_options(self, *, need_ego: bool = True) -> IngestOptions:
        """Return the options for reading. Errors: `UsageError` for a condition that does not exist."""
        return IngestOptions(
            self.mapping,
            self.ego,
            self.topic,
            self.sensor_range_m,
            need_ego=need_ego,
            conditions=conditions.parse_env_settings(self.env),
            ego_size=self.ego_size,
            in_sight=self.visibility == "line-of-sight",
            map=self.map,
        )


class FrameTimes(NamedTuple):
    """The times of a log's frames in the order of the file: `t_ns` from the message, `log_ns` from the container."""

    t_ns: Times
    log_ns: NDArray[np.uint64]


@dataclass(frozen=True)
class Trace:
    """One drive as tables of `schemas/model.sql` (data_log, actor, actor_state, signal_state, declared_event,
    drive_condition, quality).

    `data_log` has one row, with a NULL `environment_id`. Every table is sorted, `actor_state` by actor_id and t_ns. `embedded_map`: the
    OpenDRIVE text that the log contains. `map_offset` (metres) is added to the map's coordinates. `frame_times` is None for a log with
    one clock. `geo_reference`: the PROJ string of a projection. `geo_offset` converts the log's coordinates into projected ones: x and y in
    metres, after a rotation (radians). `times_without_actors_ns`: times of frames without actors while the ego is absent.
    `in_log_order`: the states are those of the log (`IngestOptions.as_recorded`) in its own order, because its clock restarts.
    `fixed_frame`: the frame of the positions, if the log names it.
    """

    drive_id: str
    path: Path
    tables: dict[str, pa.Table]
    embedded_map: bytes | None
    map_offset: tuple[float, float] | None
    notes: list[str]
    frame_times: FrameTimes | None = None
    geo_reference: str | None = None
    geo_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    times_without_actors_ns: Times = field(default_factory=lambda: np.zeros(0, np.int64))
    in_log_order: bool = False
    fixed_frame: str = ""


class Doubt(NamedTuple):
    """One row of the table `doubt`, without the drive and the code (the check id of the finding that has the doubt)."""

    actor_id: str
    quantity: Quantity
    t_from_ns: int
    t_to_ns: int


@dataclass(frozen=True)
class QualityFinding:
    """One row of the table `quality`, without the drive. `doubts`: the values that the finding makes doubtful."""

    check_id: str
    severity: Severity
    message: str
    n: int = 1
    t_first_ns: int | None = None
    actor_id: str | None = None
    t_last_ns: int | None = None
    doubts: tuple[Doubt, ...] = ()

    @classmethod
    def unusable_map(cls, message: str) -> QualityFinding:
        """Return the finding that the log's own map cannot be used."""
        return cls(OWN_MAP_UNUSABLE_CHECK, "warning", message)

    @classmethod
    def of_actors(cls, check_id: str, severity: Severity, message: str, ids: Sequence[str]) -> QualityFinding:
        """Return a finding about these actors; its `actor_id` is set if there is only one."""
        return cls(check_id, severity, message, len(ids), actor_id=ids[0] if len(ids) == 1 else None)


def single_map_or_finding(topic_by_map: Mapping[bytes, str]) -> tuple[bytes | None, tuple[QualityFinding, ...]]:
    """Return the log's only OpenDRIVE map, or None with a finding if there are several.

    `topic_by_map`: map text -> the topic that first had it.
    """
    if len(topic_by_map) > 1:
        message = (
            f"the log has {len(topic_by_map)} different OpenDRIVE maps (topics {name_list(sorted(topic_by_map.values()))}), and "
            "none is used: keep only one in the log"
        )
        return None, (QualityFinding.unusable_map(message),)
    return next(iter(topic_by_map), None), ()


@dataclass
class States:
    """Rows of `actor_state` as parallel arrays, SI units, box centres; NaN and code -1 mean unknown.

    `ids`: the distinct actor ids. `actor`: for each row, an index into `ids`. `numbers`: some or all of `STATE_COLUMNS` and
    `SIZE_COLUMNS`. `codes`: indices into `INDICATORS`, `BRAKE_LIGHTS` and `ACTOR_CLASSES`. `not_finite`: the rows in which the log has
    NaN or infinity.
    """

    ids: list[str]
    actor: NDArray[np.int32]
    t_ns: Times
    numbers: dict[str, Floats]
    codes: dict[str, Codes]
    not_finite: Mask

    def __len__(self) -> int:
        return len(self.t_ns)

    @property
    def place(self) -> Floats:
        """The positions x and y (2, n) in metres."""
        return np.stack([self.numbers["x_m"], self.numbers["y_m"]])

    @property
    def velocity(self) -> Floats:
        """The velocities along x and y (2, n) in m/s."""
        return np.stack([self.numbers["vx_mps"], self.numbers["vy_mps"]])

    def copy(self) -> States:
        """Return a shallow copy: it shares the arrays, but replacing an array in one of the two does not change the other."""
        return States(self.ids, self.actor, self.t_ns, dict(self.numbers), dict(self.codes), self.not_finite)

    def with_all_columns(self) -> States:
        """Return the rows with every column of `STATE_COLUMNS`; columns that the log lacks are unknown."""
        missing_columns = {name: np.full(len(self), np.nan) for name in STATE_COLUMNS if name not in self.numbers}
        return States(self.ids, self.actor, self.t_ns, self.numbers | missing_columns, self.codes, self.not_finite)

    def take(self, rows: Indices | Mask | slice) -> States:
        """Return the chosen rows (indices, a mask or a slice), ids unchanged."""
        return States(
            self.ids,
            self.actor[rows],
            self.t_ns[rows],
            {name: values[rows] for name, values in self.numbers.items()},
            {name: codes[rows] for name, codes in self.codes.items()},
            self.not_finite[rows],
        )

    @classmethod
    def concatenate(cls, parts: Sequence[States]) -> States:
        """Return the rows of all parts, which have the same ids and columns."""
        first = parts[0]
        if len(parts) == 1:
            return first
        return cls(
            first.ids,
            np.concatenate([part.actor for part in parts]),
            np.concatenate([part.t_ns for part in parts]),
            {name: np.concatenate([part.numbers[name] for part in parts]) for name in first.numbers},
            {name: np.concatenate([part.codes[name] for part in parts]) for name in first.codes},
            np.concatenate([part.not_finite for part in parts]),
        )

    def findings(
        self,
        rows: Mask,
        check_id: str,
        severity: Severity,
        text: str,
        *,
        quantity: Quantity | None = None,
    ) -> list[QualityFinding]:
        """Return a list of one finding about the rows of a mask, or an empty list if the mask is empty.

        `text`: the message, with {n}, {of} and {ids}. `quantity`: the quantity that is doubtful in those rows, or None; it needs states
        in order.
        """
        n = int(rows.sum())
        if not n:
            return []
        ids = [self.ids[i] for i in np.unique(self.actor[rows])]
        message = text.format(n=n, of=len(self), ids=name_list(ids))
        only = ids[0] if len(ids) == 1 else None
        doubts = () if quantity is None else self.doubts(rows, quantity)
        return [QualityFinding(check_id, severity, message, n, int(self.t_ns[rows].min()), only, doubts=doubts)]

    def doubts(self, rows: Mask, quantity: Quantity) -> tuple[Doubt, ...]:
        """Return a doubt for each run of rows of a mask (n, in order).

        A doubt extends to 1 ns before the samples next to its run. So a state that is interpolated between a doubtful sample and its
        neighbour is doubtful too.
        """
        change = self.actor[1:] != self.actor[:-1]
        first = np.flatnonzero(rows & np.r_[True, change | ~rows[:-1]])
        last = np.flatnonzero(rows & np.r_[change | ~rows[1:], True])
        first_of_track, last_of_track = np.r_[True, change], np.r_[change, True]
        before, after = np.r_[self.t_ns[:1], self.t_ns[:-1]], np.r_[self.t_ns[1:], self.t_ns[-1:]]
        from_ns = np.where(first_of_track[first], self.t_ns[first], before[first] + 1)
        to_ns = np.where(last_of_track[last], self.t_ns[last], after[last] - 1)
        names = [self.ids[i] for i in self.actor[first]]
        return tuple(
            Doubt(name, quantity, int(t_from), int(t_to))
            for name, t_from, t_to in zip(names, from_ns, to_ns, strict=True)
        )


class LostTime(NamedTuple):
    """A span of log time from which messages may be missing, and the cause. None: from the log's start, or until its end."""

    since_ns: int | None
    until_ns: int | None
    cause: str


@dataclass
class Recording:
    """The output of a reader: rows in the log's own order, neither sorted nor checked.

    `actors`: an Arrow table with the columns of `actor`, if the log has a separate actor table. `ego_ids`: the egos that the log or the
    mapping names. `lost_times`: spans that a damaged log lacks. `conditions`: condition -> word, as the log states them. `strict_units`:
    units and frame come from a mapping that the user can correct. `geo_reference`, `geo_offset`, `fixed_frame`: as in `Trace`.
    `frames_ns`: the times of all frames, also of those without actors; None: the times of the states. `names_indicator`: whether a mapping
    names the column of the indicators. `ends_apart_ns`: by how much the starts, or the ends, of parallel topics may differ.
    `why_no_ego`: why the log names no ego. `outlines`: things that do not move and are no actors.
    """

    format: str
    states: States
    actors: pa.Table | None = None
    signals: pa.Table | None = None
    events: pa.Table | None = None
    conditions: dict[str, str] = field(default_factory=dict)
    ego_ids: list[str] = field(default_factory=list)
    findings: list[QualityFinding] = field(default_factory=list)
    lost_times: list[LostTime] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    embedded_map: bytes | None = None
    map_offset: tuple[float, float] | None = None
    utc_start_ns: int | None = None
    sensor_range_m: float | None = None
    strict_units: bool = False
    frame_times: FrameTimes | None = None
    geo_reference: str | None = None
    geo_offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    frames_ns: Times | None = None
    ends_apart_ns: int = 0
    names_indicator: bool | None = None
    why_no_ego: str = ""
    fixed_frame: str = ""
    outlines: list[Outline] = field(default_factory=list)

    def hand_over_states(self) -> States:
        """Return the states and drop them here, so that memory contains the states of a long drive only once."""
        states, self.states = self.states, self.states.take(slice(0))
        return states
