"""Joins a rider and the ridden vehicle to one road user, if the data set annotates each with its own box.

Two boxes in one place would count as a lasting contact, and as two vehicles being passed. The rider gets the box around both; the ridden
vehicle has no state of its own while a rider is on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from drivelint.arrays import rotate_vectors

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Indices, Mask, Times

MAX_RIDER_CENTRE_OUTSIDE_VEHICLE_BOX_M: Final = 0.5
"""How far the centre of a rider may lie outside the ridden vehicle's box: annotators draw both boxes from few lidar points."""
MAX_HEIGHT_BETWEEN_RIDER_AND_VEHICLE_M: Final = 2.0
"""The largest difference in height between the centres of a rider and the ridden vehicle."""
_SIZE_COLUMNS: Final = ("length_m", "width_m", "height_m")


def join_riders_and_return_merged_rows_and_rider_tracks(
    t_ns: Times, actor: NDArray[np.int32], rider: Mask, ridden: Mask, boxes: dict[str, Floats]
) -> tuple[Mask, list[int]]:
    """Give riders the box around them and their vehicle, in place. Return which rows another row's box includes, and the riders' tracks.

    Arguments, for n boxes: time, track, whether it is a rider or a ridden vehicle, and the columns x_m, y_m, z_m, yaw_rad, length_m,
    width_m, height_m. A rider must be on the vehicle in most samples that both have. Of several riders on a vehicle, the first track gets
    the box.
    """
    inside = np.zeros(len(t_ns), np.bool_)
    on, under = _riders_and_vehicles(t_ns, actor, rider, ridden, boxes)
    if not len(on):
        return inside, []
    order = np.lexsort((actor[on], under))
    on, under = on[order], under[order]
    first = np.flatnonzero(np.r_[True, under[1:] != under[:-1]])
    keeper, thing = on[first], under[first]
    low, high = _rider_ends_along_vehicle_axes(on, under, boxes)
    size = np.stack([boxes[name] for name in _SIZE_COLUMNS])
    low = np.fmin(np.fmin.reduceat(low, first, axis=1), -size[:, thing] / 2)
    high = np.fmax(np.fmax.reduceat(high, first, axis=1), size[:, thing] / 2)
    ahead, left, up = (low + high) / 2
    dx, dy = rotate_vectors(ahead, left, boxes["yaw_rad"][thing])
    for name, values in (("x_m", dx), ("y_m", dy), ("z_m", up), ("yaw_rad", np.zeros(len(thing)))):
        boxes[name][keeper] = boxes[name][thing] + values
    riders = np.unique(actor[keeper]).tolist()
    for name, values in zip(_SIZE_COLUMNS, high - low, strict=True):
        for number in riders:  # one size for all times: the two boxes jitter against each other
            of_track = actor[keeper] == number
            boxes[name][keeper[of_track]] = np.median(values[of_track])
    inside[under] = inside[on] = True
    inside[keeper] = False
    return inside, riders


def _riders_and_vehicles(
    t_ns: Times, actor: NDArray[np.int32], rider: Mask, ridden: Mask, boxes: dict[str, Floats]
) -> tuple[Indices, Indices]:
    """Return the rows of riders who are on a vehicle, each once, and for each the row of that vehicle."""
    on, under = np.flatnonzero(rider), np.flatnonzero(ridden)
    under = under[np.argsort(t_ns[under], kind="stable")]
    begin, end = (np.searchsorted(t_ns[under], t_ns[on], side=side) for side in ("left", "right"))
    n = end - begin
    on, place = np.repeat(on, n), np.arange(n.sum()) - np.repeat(np.cumsum(n) - n - begin, n)
    under = under[place]
    near = _is_over(on, under, boxes)
    of = np.unique(actor[on].astype(np.int64) << 32 | actor[under], return_inverse=True)[1]
    n_near = np.bincount(of, near)
    rides = near & (2 * n_near > np.bincount(of))[of]
    on, under, n_near = on[rides], under[rides], n_near[of[rides]]
    order = np.lexsort((actor[under], -n_near, on))
    on, under = on[order], under[order]
    once = np.r_[True, on[1:] != on[:-1]][: len(on)]
    return on[once], under[once]


def _is_over(on: Indices, under: Indices, boxes: dict[str, Floats]) -> Mask:
    """Return for pairs of rows whether the centre of the box `on` is over the box `under`, or just beside it.

    Just beside: within `MAX_RIDER_CENTRE_OUTSIDE_VEHICLE_BOX_M`.
    """
    dx, dy = _relative_position(on, under, boxes)
    half_length, half_width = (
        boxes[name][under] / 2 + MAX_RIDER_CENTRE_OUTSIDE_VEHICLE_BOX_M for name in _SIZE_COLUMNS[:2]
    )
    level = np.abs(boxes["z_m"][on] - boxes["z_m"][under]) <= MAX_HEIGHT_BETWEEN_RIDER_AND_VEHICLE_M
    return (np.abs(dx) <= half_length) & (np.abs(dy) <= half_width) & level


def _relative_position(on: Indices, under: Indices, boxes: dict[str, Floats]) -> tuple[Floats, Floats]:
    x, y = boxes["x_m"], boxes["y_m"]
    return rotate_vectors(x[on] - x[under], y[on] - y[under], -boxes["yaw_rad"][under])


def _rider_ends_along_vehicle_axes(on: Indices, under: Indices, boxes: dict[str, Floats]) -> tuple[Floats, Floats]:
    """Return the lower and upper ends (3, n) of the boxes `on` along the axes of the boxes `under`, from the centres of these (m)."""
    angle = boxes["yaw_rad"][on] - boxes["yaw_rad"][under]
    cos, sin = np.abs(np.cos(angle)), np.abs(np.sin(angle))
    length, width, height = (boxes[name][on] for name in _SIZE_COLUMNS)
    half = np.stack([length * cos + width * sin, length * sin + width * cos, height]) / 2
    middle = np.stack([*_relative_position(on, under, boxes), boxes["z_m"][on] - boxes["z_m"][under]])
    return middle - half, middle + half
