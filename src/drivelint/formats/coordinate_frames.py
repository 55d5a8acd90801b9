"""Transforms poses from the frame in which they are recorded to the fixed frame, along the chain of transforms.

A transform that changes is interpolated between two times, never extrapolated: a pose that cannot be transformed has the place NaN.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    Vectors = NDArray[np.float64]

    from drivelint.arrays import Times

FIXED_FRAME_NAMES: Final = ("map", "world", "odom")
"""The names that the fixed frame may have, best first. By REP 105, `map` does not drift and `odom` does."""
MAX_INTERPOLATED_GAP_NS: Final = 500_000_000
"""Transforms further apart are not interpolated: in 0.5 s, a car at 20 m/s that turns at 0.5 rad/s deviates from the chord by 0.3 m."""


class Poses(NamedTuple):
    """n poses: `place` (n, 3) metres, `turn` (n, 4) quaternions x, y, z, w; NaN where unknown."""

    place: Vectors
    turn: Vectors

    @property
    def yaw(self) -> Vectors:
        """Return the headings (n,) in radians."""
        x, y, z, w = self.turn.T
        yaw: Vectors = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        return yaw

    def compose(self, inner: Poses) -> Poses:
        """Return the poses `inner`, given relative to these poses, in the frame in which these poses are given."""
        return Poses(self.place + rotated(self.turn, inner.place), _quaternion_products(self.turn, inner.turn))


@dataclass
class _Transform:
    """The poses of a frame in its parent frame: at ascending times, or one for all times (`static`)."""

    parent: str
    static: bool
    t_ns: Times
    poses: Poses


@dataclass
class TransformTree:
    """The transforms of a log. `ambiguous`: frames with several parents."""

    transforms: dict[str, _Transform] = field(default_factory=dict)
    ambiguous: set[str] = field(default_factory=set)

    def add(self, child: str, parent: str, t_ns: Times, poses: Poses, *, static: bool) -> None:
        """Add transforms of a frame. A second parent makes the frame ambiguous. Of several static transforms, the last applies."""
        known_transform = self.transforms.get(child)
        if known_transform is not None and known_transform.parent != parent:
            self.ambiguous.add(child)
            return
        if known_transform is not None:
            t_ns = np.concatenate([known_transform.t_ns, t_ns])
            poses = Poses(*map(np.concatenate, zip(known_transform.poses, poses, strict=True)))
            static = static and known_transform.static
        t_ns, last = np.unique(t_ns[::-1], return_index=True)
        last = len(poses.place) - 1 - last
        self.transforms[child] = _Transform(parent, static, t_ns, Poses(*(column[last] for column in poses)))

    def chain(self, frame: str, fixed: str) -> list[_Transform] | None:
        """Return the transforms from a frame up to the fixed frame; None if no chain leads there."""
        transforms: list[_Transform] = []
        while frame != fixed:
            transform = self.transforms.get(frame)
            if transform is None or frame in self.ambiguous or len(transforms) > len(self.transforms):
                return None
            transforms.append(transform)
            frame = transform.parent
        return transforms

    def root(self, frame: str) -> str:
        """Return the topmost frame above a frame."""
        for _ in range(len(self.transforms) + 1):
            if frame not in self.transforms or frame in self.ambiguous:
                break
            frame = self.transforms[frame].parent
        return frame

    def frame_poses(self, fixed: str, frame: str, t_ns: Times) -> Poses:
        """Return the poses of `frame` in the fixed frame at given times, NaN where they are not known."""
        n = len(t_ns)
        chain = self.chain(frame, fixed)
        if chain is None:
            return Poses(np.full((n, 3), np.nan), np.full((n, 4), np.nan))
        poses = Poses(np.zeros((n, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (n, 1)))
        for transform in chain:
            poses = _poses_at(transform, t_ns).compose(poses)
        return poses


def fixed_frame(frames: TransformTree, frame_names: Iterable[str]) -> str:
    """Return the fixed frame for poses in the frames `frame_names` (names as recorded, the most important first).

    This is the first of `FIXED_FRAME_NAMES` to which a chain leads from any of them, else the topmost frame above the first of them.
    """
    names = [clean_frame_name(name) for name in frame_names]
    for candidate in FIXED_FRAME_NAMES:
        if any(frames.chain(name, candidate) is not None for name in names):
            return candidate
    return frames.root(names[0]) if names else FIXED_FRAME_NAMES[0]


def clean_frame_name(name: str) -> str:
    """Return a frame's name without the leading slash of old recordings."""
    return name.removeprefix("/")


def unit_quaternions(turn: Vectors) -> Vectors:
    """Return the quaternions scaled to length one; NaN for quaternions that are all zero."""
    length = np.sqrt(np.einsum("ij,ij->i", turn, turn))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where((length > 1e-6)[:, None], turn / length[:, None], np.nan)


def rotated(turn: Vectors, vectors: Vectors) -> Vectors:
    """Return vectors rotated by quaternions."""
    axis, w = turn[:, :3], turn[:, 3:]
    twice = 2.0 * _cross_products(axis, vectors)
    result: Vectors = vectors + w * twice + _cross_products(axis, twice)
    return result


def _cross_products(a: Vectors, b: Vectors) -> Vectors:
    """Return the cross products of the rows, in a third of the time of `numpy.cross`."""
    result = np.empty_like(b)
    for k, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        result[:, k] = a[:, i] * b[:, j] - a[:, j] * b[:, i]
    return result


def _quaternion_products(a: Vectors, b: Vectors) -> Vectors:
    av, aw, bv, bw = a[:, :3], a[:, 3:], b[:, :3], b[:, 3:]
    return np.concatenate(
        [aw * bv + bw * av + _cross_products(av, bv), aw * bw - (av * bv).sum(axis=1, keepdims=True)], axis=1
    )


def _poses_at(transform: _Transform, t_ns: Times) -> Poses:
    """Interpolate a transform: places linearly, rotations along the shorter arc.

    NaN outside its times and in gaps over `MAX_INTERPOLATED_GAP_NS`.
    """
    if transform.static:
        return Poses(*(np.repeat(column[-1:], len(t_ns), axis=0) for column in transform.poses))
    after = np.clip(np.searchsorted(transform.t_ns, t_ns), 0, len(transform.t_ns) - 1)
    exact = transform.t_ns[after] == t_ns
    before = np.where(exact, after, np.maximum(after - 1, 0))
    span = transform.t_ns[after] - transform.t_ns[before]
    inside = exact | (
        (transform.t_ns[before] < t_ns) & (t_ns < transform.t_ns[after]) & (span <= MAX_INTERPOLATED_GAP_NS)
    )
    share = np.where(span > 0, (t_ns - transform.t_ns[before]) / np.maximum(span, 1), 0.0)[:, None]
    first, second = transform.poses.turn[before], transform.poses.turn[after]
    near = np.where((first * second).sum(axis=1, keepdims=True) < 0.0, -second, second)
    place = transform.poses.place[before] * (1.0 - share) + transform.poses.place[after] * share
    turn = unit_quaternions(first * (1.0 - share) + near * share)
    return Poses(np.where(inside[:, None], place, np.nan), np.where(inside[:, None], turn, np.nan))
