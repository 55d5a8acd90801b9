"""How the road users of the drives move."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tests.outsiders.eighteenth.roads import Array, Path


@dataclass
class Track:
    """Somebody who follows a way, at an offset o to the side that is driven on (g is that side)."""

    name: str
    kind: str | None
    size: tuple[float, float]
    path: Path
    s: float
    v: float
    o: float = 0.0
    g: int = -1
    pace: list[tuple[float, float]] = field(default_factory=list)  # for so long this acceleration
    moves: list[tuple[float, float, float]] = field(default_factory=list)  # from t to t, to the offset o
    lamps: list[tuple[float, str]] = field(default_factory=list)  # from t on this indicator
    backwards: bool = False  # may go backwards from standing
    known: tuple[float, float] = (0.0, 1e9)
    lost: tuple[float, float] | None = None
    still: float | None = None  # heading kept, for those who only stand
    behind: float = 0.0  # so far behind the track's own motion: trailers

    def seen(self, t: float) -> bool:
        """Whether the log has it then."""
        return self.known[0] <= t <= self.known[1] and not (self.lost and self.lost[0] <= t < self.lost[1])

    def lamp(self, t: float) -> str:
        """Return its indicator."""
        return next((state for since, state in reversed(self.lamps) if t >= since - 1e-9), "off")

    def _driven(self, fine: Array) -> tuple[Array, Array]:
        """Return speed and acceleration at fine steps of time."""
        v = np.zeros_like(fine)
        a = np.zeros_like(fine)
        begin, speed = 0.0, self.v
        for length, accel in [*self.pace, (1e6, 0.0)]:
            here = (fine >= begin - 1e-9) & (fine < begin + length - 1e-9)
            values = speed + accel * (fine[here] - begin)
            last = speed + accel * length
            if speed > 0 or not self.backwards:
                stopped = values < 0 if speed >= 0 else values > 0
                values[stopped] = 0.0
                last = max(0.0, last) if speed >= 0 else min(0.0, last)
            v[here], a[here] = values, np.where(values == 0, 0.0, accel)
            begin, speed = begin + length, last
        return v, a

    def at(self, times: Array) -> tuple[Array, Array, Array, Array, Array, Array]:
        """x, y, yaw, vx, vy and acceleration at the times."""
        fine = np.arange(0.0, float(times[-1]) + 0.3, 0.01)
        v, a = self._driven(fine)
        s = self.s - self.behind + np.concatenate([[0.0], np.cumsum((v[1:] + v[:-1]) / 2 * 0.01)])
        o = np.full_like(fine, self.o)
        now = self.o
        for t0, t1, o1 in self.moves:
            share = np.clip((fine - t0) / (t1 - t0), 0, 1)
            o = o + (o1 - now) * (1 - np.cos(np.pi * share)) / 2
            now = o1
        px, py, h = self.path.at(s)
        x, y = px - np.sin(h) * self.g * o, py + np.cos(h) * self.g * o
        vx, vy = np.gradient(x, 0.01), np.gradient(y, 0.01)
        slow = np.abs(v) < 0.3
        drift = np.where(slow, 0.0, np.arctan2(self.g * np.gradient(o, 0.01), np.where(slow, 1.0, v)))
        drift = np.where(v < 0, np.arctan(np.tan(drift)), drift)
        yaw = h + drift if self.still is None else np.full_like(h, self.still)
        pick = np.clip(np.round(times / 0.01).astype(int), 0, len(fine) - 1)
        return x[pick], y[pick], yaw[pick], vx[pick], vy[pick], a[pick]


def trailer(track: Track, name: str, size: tuple[float, float] = (8.0, 2.5), gap: float = 0.8) -> Track:
    """A trailer behind somebody, on the same way a little later."""
    back = track.size[0] / 2 + gap + size[0] / 2
    late = back / max(track.v, 1.0)
    moves = [(t0 + late, t1 + late, o) for t0, t1, o in track.moves]
    return Track(
        name,
        "trailer",
        size,
        track.path,
        track.s,
        track.v,
        track.o,
        track.g,
        list(track.pace),
        moves,
        backwards=track.backwards,
        behind=back,
    )
