"""Derives velocities from positions by a filter whose width depends on the position noise and whose error is known.

The velocity at a state is the least-squares slope of the positions within a half width before and after it: the smallest of
`FILTER_HALF_WIDTHS_S` for which three standard errors are at most `LARGEST_VELOCITY_ERROR_MPS`. Exact positions (from a simulator) need
central differences only; noise of 5 cm at 10 Hz needs half a second. If one second is not enough, the velocity is unknown. An actor that
moves no more than its noise over two seconds stands still.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint.drive.order import prefix_sums, steps_between, time_derivative

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Indices, Mask, Times
    from drivelint.drive.order import Steps


LARGEST_VELOCITY_ERROR_MPS: Final = 0.25
"""A velocity component is known if three standard errors are at most this: half of the speed that counts as standing (`standing_mps`)."""
FILTER_HALF_WIDTHS_S: Final = (0.25, 0.5, 1.0)
"""Half widths of the filter in seconds, tried in this order if central differences are too noisy.

At a jerk of 10 m/s3, the derived velocities are wrong by up to 0.06, 0.25 and 1 m/s."""
LONGEST_SAMPLING_PERIOD_TO_FILTER_NS: Final = 210_000_000
"""With longer sampling periods, motion cannot be separated from noise: central differences are used, as for exact positions."""
LEAST_POSITION_SPREAD_OF_MOVING_ACTOR_M: Final = 1.0
"""An actor moves if its positions spread by more than this; the noise of a parked car's positions stays below it."""
LEAST_SAMPLES_TO_ESTIMATE_NOISE: Final = 8
"""Noise is not estimated from fewer samples than this."""


class DerivedVelocity(NamedTuple):
    """Velocities (2, n) in m/s, NaN if unknown; `filtered` (n): the filter was used, or the velocity is unknown because of noise."""

    v_mps: Floats
    filtered: Mask


def derive_velocities(t_ns: Times, actor: NDArray[np.int32], place: Floats, step: Steps) -> DerivedVelocity:
    """Derive velocities from positions (2, n) in metres, sorted by actor and time; `actor` (n): the actor's number."""
    v = time_derivative(place, step)
    filtered = np.zeros(len(t_ns), np.bool_)
    with_place = np.flatnonzero(np.isfinite(place).all(axis=0))
    if not 0 < step.period_ns <= LONGEST_SAMPLING_PERIOD_TO_FILTER_NS or not len(with_place):
        return DerivedVelocity(v, filtered)
    # a filter does not need a sample at every step: it continues over a single sample without a position
    of = steps_between(t_ns[with_place], actor[with_place], step.period_ns, step.track_period_ns[with_place])
    v[:, with_place], filtered[with_place] = _filtered_velocities(
        t_ns[with_place], actor[with_place], place[:, with_place], of, v[:, with_place]
    )
    return DerivedVelocity(v, filtered)


def _filtered_velocities(
    t_ns: Times, actor: NDArray[np.int32], place: Floats, step: Steps, central_velocities: Floats
) -> DerivedVelocity:
    """Return the velocities (2, n) of samples that all have a position; `central_velocities`: the velocities by central differences."""
    runs = Tracklets.from_samples(t_ns, place, step)
    sigma = noise_of_samples_m(place, runs, actor, default_m=0.0)
    has_velocity = 3.0 * sigma * np.sqrt(2.0) / (2.0 * step.track_period_ns * 1e-9) <= LARGEST_VELOCITY_ERROR_MPS
    v, filtered = np.where(has_velocity, central_velocities, np.nan), np.zeros(len(t_ns), np.bool_)
    for width in FILTER_HALF_WIDTHS_S:
        if has_velocity.all():
            break
        wide, error = runs.slopes_with_errors(place, width, sigma)
        now = ~has_velocity & (error <= LARGEST_VELOCITY_ERROR_MPS)
        v, has_velocity, filtered = np.where(now, wide, v), has_velocity | now, filtered | now
    # the widest filter decides which actors stand still; at the ends of a track it is one-sided
    wide, error = runs.slopes_with_errors(place, FILTER_HALF_WIDTHS_S[-1], sigma, both_sides=False)
    stands = (sigma > 0.0) & (error <= LARGEST_VELOCITY_ERROR_MPS) & (np.abs(wide) <= error).all(axis=0)
    return DerivedVelocity(np.where(stands, 0.0, v), filtered | (~has_velocity & ~stands))


class Tracklets(NamedTuple):
    """For each state, the first and last row of its tracklet (a stretch of one actor without holes) and the time since the first.

    `key`, ascending: the time within the tracklet plus an offset per tracklet.
    """

    first: Indices
    last: Indices
    key: Times
    t_s: Floats

    @classmethod
    def from_samples(cls, t_ns: Times, place: Floats, step: Steps) -> Tracklets:
        """Split the states (n, in order) at holes and at samples without a position (`place`: 2, n)."""
        usable: Mask = np.logical_and.reduce(np.isfinite(place))
        starts = np.flatnonzero(np.r_[True, ~(step.continuous & usable[1:] & usable[:-1])])
        of = np.repeat(np.arange(len(starts)), np.diff(np.r_[starts, len(t_ns)]))
        first = starts[of]
        last = np.r_[starts[1:], len(t_ns)][of] - 1
        since = t_ns - t_ns[first]
        key = since + of.astype(np.int64) * (2 * int(since.max(initial=0)) + 4_000_000_000)
        return cls(first, last, key, since.astype(np.float64) * 1e-9)

    def slopes_with_errors(
        self, place: Floats, half_width_s: float, noise_m: Floats, *, both_sides: bool = True
    ) -> tuple[Floats, Floats]:
        """Return the slopes (2, n) over the samples within `half_width_s`, and three standard errors.

        `both_sides`: the window is symmetric, so it becomes narrower at the ends of a tracklet.
        """
        to_edge = np.minimum(self.t_s - self.t_s[self.first], self.t_s[self.last] - self.t_s)
        half = (
            np.round(np.minimum(half_width_s, to_edge if both_sides else half_width_s) * 1e9).astype(np.int64)
            + 1_000_000
        )
        low = np.maximum(np.searchsorted(self.key, self.key - half, side="left"), self.first)
        end = np.minimum(np.searchsorted(self.key, self.key + half, side="right") - 1, self.last) + 1
        n = (end - low).astype(np.float64)

        def sum_in_window(values: Floats) -> Floats:
            sums = prefix_sums(values)
            return sums.take(end, axis=-1) - sums.take(low, axis=-1)

        # relative to the first sample of the tracklet, so that the sums do not lose precision
        t, way = self.t_s, np.nan_to_num(place - place.take(self.first, axis=1))
        mean_t = sum_in_window(t) / n
        spread = sum_in_window(t * t) - n * mean_t * mean_t
        spread = np.where(spread > 1e-9, spread, np.nan)
        slopes = (sum_in_window(t * way) - mean_t * sum_in_window(way)) / spread
        return slopes, np.where(np.isfinite(spread), 3.0 * noise_m / np.sqrt(spread), np.inf)


def noise_of_samples_m(
    place: Floats, tracklets: Tracklets, actor: NDArray[np.int32], *, default_m: float = np.inf
) -> Floats:
    """Return the standard deviation of each sample's position noise (m); `default_m` is the value for actors with too few samples."""
    sigma = np.maximum(*(noise_by_actor_m(values, tracklets, actor) for values in place))
    sigma[np.bincount(actor) < LEAST_SAMPLES_TO_ESTIMATE_NOISE] = default_m
    return sigma[actor]


def noise_by_actor_m(coordinates: Floats, tracklets: Tracklets, actor: NDArray[np.int32]) -> Floats:
    """Return the standard deviation of each actor's position noise (m), estimated by a median; 0 for actors with too few samples.

    A sample is off the line between its neighbours because of noise or acceleration. A constant acceleration cancels in the difference
    of two successive offsets; this difference has five times the variance of the noise.
    """
    n_actors = int(actor.max(initial=-1)) + 1
    noise_m = np.zeros(n_actors)
    t = tracklets.t_s
    inner = np.arange(1, len(coordinates) - 1)
    share = (t[inner] - t[inner - 1]) / (t[inner + 1] - t[inner - 1])
    beside = coordinates[inner] - coordinates[inner - 1] - share * (coordinates[inner + 1] - coordinates[inner - 1])
    twice = np.abs(np.diff(beside))  # `whole` leaves out differences between samples of two tracklets
    whole = (tracklets.first[inner[:-1] - 1] == tracklets.first[inner[1:] + 1]) & np.isfinite(twice)
    rows, actor_of_row = twice[whole], actor[inner[:-1]][whole]
    edges = np.searchsorted(actor_of_row, np.arange(n_actors + 1))
    for number in np.flatnonzero(np.diff(edges) >= LEAST_SAMPLES_TO_ESTIMATE_NOISE):
        noise_m[number] = 1.4826 * np.median(rows[edges[number] : edges[number + 1]]) / np.sqrt(5.0)
    return noise_m
