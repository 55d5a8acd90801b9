"""The relative motion of two parties: gap, closing speed, braking, and a table with a row per second."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import shapely

from drivelint.arrays import Floats, Mask, floats

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pyarrow as pa

SECONDS_BEFORE_MOMENT: Final = 15
SECONDS_AFTER_MOMENT: Final = 2
"""The table runs from 15 s before the moment to 2 s after it."""
MOST_ROWS_OF_SECONDS_TABLE: Final = SECONDS_BEFORE_MOMENT + SECONDS_AFTER_MOMENT + 2
"""The greatest number of rows of the table: its seconds, the moment, and the last step before a contact."""
LEAST_SLOWING_MPS2: Final = 1.0
"""A vehicle whose mean deceleration over half a second is less may be coasting."""
_LEAST_IMPACT_LOSS_MPS2, _LEAST_IMPACT_LOSS_MPS = 12.0, 1.0
"""Tyres cannot brake a vehicle this hard: a loss of speed of this rate and size between two steps is an impact."""
_LARGEST_STANDING_SPEED_MPS: Final = 0.5
"""The same value as in the rules (`standing_mps`)."""
_ACCELERATION_AVERAGING_PERIOD_S: Final = 0.5
_LONGEST_BREAK_IN_SLOWING_S: Final = 0.5
"""Two periods of slowing with a shorter break between them are merged."""


@dataclass(frozen=True)
class MotionOfParties:
    """The steps of a drive as arrays; in each pair the ego's comes first, then the other party's. NaN: not known.

    `t`: seconds from the moment; `velocity`: along x and y, shape (2, n), in m/s; `backwards`: moves against its heading;
    `lane_offset`: from the centre of the ego's lane, left positive. `gap`: distance of the boxes in m, negative: depth of overlap;
    `closing`: speed at which the distance of the box centres decreases; `relative`: relative speed; `turn`: angle between the headings.
    `is_aside`: they pass beside each other; `is_alongside`: their lengths are side by side too.
    `out_since`: when the ego left its lane, in seconds from the moment; NaN: the ego is in its lane, or this was not examined.
    """

    t: Floats
    speed: tuple[Floats, Floats]
    velocity: tuple[Floats, Floats]
    backwards: tuple[Mask, Mask]
    lane_offset: tuple[Floats, Floats]
    gap: Floats
    closing: Floats
    relative: Floats
    turn: Floats
    is_aside: Mask
    is_alongside: Mask
    out_since: Floats

    @classmethod
    def of_steps(cls, steps: pa.Table, moment_ns: int) -> MotionOfParties:
        """Return the motion from rows of `queries/incident/step.sql`."""
        c = {
            name: floats(steps[name])
            for name in steps.column_names
            if name not in {"t_ns", "out_since_ns", "lanelet_id", "with_traffic"}
        }
        east, north = c["object_x_m"] - c["x_m"], c["object_y_m"] - c["y_m"]
        de, dn = c["object_vx_mps"] - c["vx_mps"], c["object_vy_mps"] - c["vy_mps"]
        far = np.hypot(east, north)
        with np.errstate(invalid="ignore", divide="ignore"):
            closing = -(east * de + north * dn) / far
        exact = c["clearance_m"]
        is_aside, is_alongside = _side_by_side_masks(c)
        return cls(
            t=(steps["t_ns"].to_numpy() - moment_ns) / 1e9,
            speed=(c["speed_mps"], c["object_speed_mps"]),
            velocity=(
                np.stack([c["vx_mps"], c["vy_mps"]]),
                np.stack([c["object_vx_mps"], c["object_vy_mps"]]),
            ),
            backwards=(_backwards_mask(c, ""), _backwards_mask(c, "object_")),
            lane_offset=(c["lane_offset_m"], c["object_lane_offset_m"]),
            gap=np.where(np.isnan(exact), _box_distances_m(c), exact),
            closing=closing,
            relative=np.hypot(de, dn),
            turn=np.abs(c["heading_diff_rad"]),
            is_aside=is_aside,
            is_alongside=is_alongside,
            out_since=(floats(steps["out_since_ns"]) - moment_ns) / 1e9,
        )

    @property
    def step_s(self) -> float:
        """The median time between two steps in seconds."""
        return float(np.median(np.diff(self.t))) if len(self.t) > 1 else 0.0

    def nearest_step(self, t: float) -> int | None:
        """Return the step nearest to a time; None if it is more than half a usual step, or half a second, away."""
        i = int(np.abs(self.t - t).argmin())
        return i if abs(self.t[i] - t) <= min(self.step_s / 2, 0.5) + 1e-6 else None

    def last_step_before(self, t: float) -> int | None:
        """Return the last step before a time; None if there is none."""
        i = int(np.searchsorted(self.t, t - 1e-9)) - 1
        return i if i >= 0 else None

    def last_step_apart_before(self, t: float) -> int | None:
        """Return the last step before a time at which the boxes do not overlap, or their gap is not known.

        Return the last step before the time if the boxes always overlap.
        """
        last = self.last_step_before(t)
        apart = np.flatnonzero(~(self.gap[: (last or 0) + 1] <= 0)).tolist()
        return last if last is None or not apart else int(apart[-1])

    def signed_speeds_mps(self, party: int) -> Floats:
        """Return the speed of a party in m/s, negative while the party moves backwards."""
        return np.where(self.backwards[party], -self.speed[party], self.speed[party])

    def mean_acceleration_mps2(self, party: int, step_no: int, over_s: float, v: Floats | None = None) -> float:
        """Return the mean rate of change of `v` in m/s2 over `over_s` before a step; NaN if `v` is not known over all of that time.

        `v`: speeds in m/s at the steps; None: the party's speed without sign.
        """
        t, v = self.t, self.speed[party] if v is None else v
        start = t[step_no] - over_s
        within = (t >= start - 1.5 * self.step_s) & (t <= t[step_no])
        if (
            t[0] > start + 1e-9
            or np.isnan(v[within]).any()
            or (np.diff(t[within]) > _ACCELERATION_AVERAGING_PERIOD_S).any()
        ):
            return float("nan")
        return float((v[step_no] - np.interp(start, t, v)) / over_s)

    def hardest_recent_braking_mps2(self, party: int, step_no: int) -> float:
        """Return the greatest deceleration (mean of half a second) that ends in the second before a step; 0: none; NaN: not known."""
        ends = np.flatnonzero((self.t > self.t[step_no] - 1.0 + 1e-9) & (self.t <= self.t[step_no] + 1e-9)).tolist()
        means = [
            self.mean_acceleration_mps2(party, end, _ACCELERATION_AVERAGING_PERIOD_S)
            for end in ends
            if not self.has_sudden_speed_loss(party, end, _ACCELERATION_AVERAGING_PERIOD_S)
        ]
        return float(np.maximum(0.0, -np.min(means))) if means else math.nan

    def sudden_speed_loss_mask(self, party: int) -> Mask:
        """Return a mask of the steps at which a party has lost speed since the previous step faster than tyres can brake."""
        loss_mps = -np.diff(self.speed[party], prepend=self.speed[party][:1])
        mask: Mask = (loss_mps >= _LEAST_IMPACT_LOSS_MPS) & (
            loss_mps >= _LEAST_IMPACT_LOSS_MPS2 * np.diff(self.t, prepend=-np.inf)
        )
        return mask

    def has_sudden_speed_loss(self, party: int, step_no: int, over_s: float) -> bool:
        """Return whether a party lost speed faster than tyres can brake in the `over_s` before a step."""
        within = (self.t > self.t[step_no] - over_s + 1e-9) & (self.t <= self.t[step_no])
        return bool(self.sudden_speed_loss_mask(party)[within].any())


def _backwards_mask(columns: dict[str, Floats], column_prefix: str) -> Mask:
    """Return a mask of the steps at which a party moves against its heading, faster than a standing vehicle may seem to move."""
    yaw = columns[f"{column_prefix}yaw_rad"]
    along: Floats = columns[f"{column_prefix}vx_mps"] * np.cos(yaw) + columns[f"{column_prefix}vy_mps"] * np.sin(yaw)
    mask: Mask = along < -_LARGEST_STANDING_SPEED_MPS
    return mask


def _side_by_side_masks(columns: dict[str, Floats]) -> tuple[Mask, Mask]:
    """Return masks of the steps at which the parties pass beside each other, and at which their lengths are side by side as well.

    In opposite directions, they pass if the centres would do so at the present velocities by half of both widths; in the same direction, if
    neither is ahead of the other. False if anything is not known.
    """
    east, north = columns["object_x_m"] - columns["x_m"], columns["object_y_m"] - columns["y_m"]
    de, dn = columns["object_vx_mps"] - columns["vx_mps"], columns["object_vy_mps"] - columns["vy_mps"]
    with np.errstate(invalid="ignore", divide="ignore"):
        apart_m = np.abs(east * dn - north * de) / np.hypot(de, dn)
    across_m, along_m = np.full(len(east), np.inf), np.zeros(len(east))
    for yaw in (columns["yaw_rad"], columns["object_yaw_rad"]):
        across_m = np.minimum(across_m, np.abs(north * np.cos(yaw) - east * np.sin(yaw)))
        along_m = np.maximum(along_m, np.abs(east * np.cos(yaw) + north * np.sin(yaw)))
    is_opposite = np.abs(columns["heading_diff_rad"]) > np.pi / 2
    is_aside = np.where(is_opposite, apart_m, across_m) >= (columns["width_m"] + columns["object_width_m"]) / 2
    return is_aside, is_aside & (along_m < (columns["length_m"] + columns["object_length_m"]) / 2)


def is_slowing_known(motion: MotionOfParties, party: int, until_s: float) -> bool:
    """Return whether a party's deceleration is known at all recorded steps of the 15 s before `until_s`."""
    t = motion.t
    begin = max(float(t[0]), until_s - SECONDS_BEFORE_MOMENT)
    steps = np.flatnonzero((t >= begin + _ACCELERATION_AVERAGING_PERIOD_S - 1e-9) & (t <= until_s + 1e-9)).tolist()
    return bool(steps) and not any(
        np.isnan(motion.mean_acceleration_mps2(party, i, _ACCELERATION_AVERAGING_PERIOD_S)) for i in steps
    )


class SlowingPeriod(NamedTuple):
    """A period in which a party slows: start, end, the speeds at both, and the hardest deceleration (mean of half a second).

    `sudden`: the party loses speed faster than tyres can brake, as in an impact; then `hardest_mps2` is NaN.
    """

    start_s: float
    end_s: float
    from_mps: float
    to_mps: float
    hardest_mps2: float
    sudden: bool = False

    @property
    def mean_mps2(self) -> float:
        """The mean deceleration."""
        return (self.from_mps - self.to_mps) / max(self.end_s - self.start_s, 1e-9)


def slowing_periods(motion: MotionOfParties, party: int, until_s: float) -> list[SlowingPeriod]:
    """Return the periods in which a party slows by `LEAST_SLOWING_MPS2` or more, in the 15 s before `until_s`, in time order."""
    t, v = motion.t, motion.speed[party]
    steps = np.flatnonzero((t >= until_s - SECONDS_BEFORE_MOMENT) & (t <= until_s + 1e-9))
    mean = {int(i): motion.mean_acceleration_mps2(party, int(i), _ACCELERATION_AVERAGING_PERIOD_S) for i in steps}
    sudden = motion.sudden_speed_loss_mask(party)
    hard = [
        i
        for i in steps.tolist()
        if mean[i] <= -LEAST_SLOWING_MPS2
        and not motion.has_sudden_speed_loss(party, i, _ACCELERATION_AVERAGING_PERIOD_S)
    ]
    periods = [
        SlowingPeriod(float(t[i - 1]), float(t[i]), float(v[i - 1]), float(v[i]), math.nan, sudden=True)
        for i in steps.tolist()
        if sudden[i]
    ]
    runs: list[list[int]] = []
    for i in hard:
        if runs and t[i] - t[runs[-1][-1]] <= _LONGEST_BREAK_IN_SLOWING_S + motion.step_s:
            runs[-1].append(i)
        else:
            runs.append([i])
    for run in runs:
        # the deceleration is a mean of the half second before a step: slowing began at the highest speed in it
        within = np.flatnonzero((t >= t[run[0]] - _ACCELERATION_AVERAGING_PERIOD_S - 1e-9) & (t <= t[run[0]]))
        first = int(within[::-1][np.argmax(v[within[::-1]])])
        periods.append(
            SlowingPeriod(
                float(t[first]), float(t[run[-1]]), float(v[first]), float(v[run[-1]]), -min(mean[i] for i in run)
            )
        )
    return sorted(periods)


def rows_of_seconds_table(motion: MotionOfParties, last_before_contact_s: float | None) -> list[dict[str, Any]]:
    """Return a row per full second from 15 s before to 2 s after the moment, and a row of the last step before a contact."""
    return [
        _row_at_step(motion, i, t, last_before_contact_s)
        for i, t in _steps_and_times_of_table(motion, last_before_contact_s)
    ]


def _steps_and_times_of_table(
    motion: MotionOfParties, last_before_contact_s: float | None
) -> Iterator[tuple[int, float]]:
    times = sorted(
        {float(t) for t in range(-SECONDS_BEFORE_MOMENT, SECONDS_AFTER_MOMENT + 1)}
        | ({last_before_contact_s} if last_before_contact_s is not None else set())
    )
    for t in times:
        if (i := motion.nearest_step(t)) is not None:
            yield i, t


def _row_at_step(
    motion: MotionOfParties, step_no: int, t: float, last_before_contact_s: float | None
) -> dict[str, Any]:
    signed = [motion.signed_speeds_mps(party) for party in (0, 1)]
    return {
        "i": step_no,
        "t": t,
        "last_before": t == last_before_contact_s,
        "moment": t == 0,
        "speed": [float(v[step_no]) for v in signed],
        "accel": [motion.mean_acceleration_mps2(party, step_no, 1.0, signed[party]) for party in (0, 1)],
        "hardest": [motion.hardest_recent_braking_mps2(party, step_no) for party in (0, 1)],
        "impact": [motion.has_sudden_speed_loss(party, step_no, 1.0) for party in (0, 1)],
        "offset": [float(v[step_no]) for v in motion.lane_offset],
        "gap": float(motion.gap[step_no]),
        "closing": float(motion.closing[step_no]),
    }


def _box_distances_m(columns: dict[str, Floats]) -> Floats:
    """Return the distance of the two boxes at each step in m; 0 where they overlap."""
    a, b = (_box_corners_m(columns, prefix) for prefix in ("", "object_"))
    known_mask: Mask = np.isfinite(np.concatenate([a, b], axis=1)).all(axis=(1, 2))
    distances_m = np.full(len(a), np.nan)
    distances_m[known_mask] = shapely.distance(shapely.polygons(a[known_mask]), shapely.polygons(b[known_mask]))
    return distances_m


def _box_corners_m(columns: dict[str, Floats], prefix: str) -> Floats:
    """Return the corners of the boxes in map metres, shape (n, 4, 2)."""
    x, y, yaw, length, width = (columns[f"{prefix}{name}"] for name in ("x_m", "y_m", "yaw_rad", "length_m", "width_m"))
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    ahead = np.stack([length / 2 * u for u, _ in corners], axis=1)
    left = np.stack([width / 2 * w for _, w in corners], axis=1)
    cos, sin = np.cos(yaw)[:, None], np.sin(yaw)[:, None]
    return np.stack([x[:, None] + ahead * cos - left * sin, y[:, None] + ahead * sin + left * cos], axis=2)
