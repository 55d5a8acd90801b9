"""Roads of my own: paths of straights and arcs, and the OpenDRIVE text of them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

GB = 1
DE = -1
W = 3.5
Array = np.ndarray


@dataclass
class Path:
    """A line of straights and arcs: each segment has a length and a curvature (left is positive)."""

    x: float
    y: float
    h: float
    parts: list[tuple[float, float]]

    @property
    def length(self) -> float:
        """How long it is."""
        return sum(p[0] for p in self.parts)

    def starts(self) -> list[tuple[float, float, float, float]]:
        """Where each segment begins: s, x, y, heading."""
        out = []
        s, x, y, h = 0.0, self.x, self.y, self.h
        for n, k in self.parts:
            out.append((s, x, y, h))
            if k == 0:
                x, y = x + n * np.cos(h), y + n * np.sin(h)
            else:
                x += (np.sin(h + k * n) - np.sin(h)) / k
                y -= (np.cos(h + k * n) - np.cos(h)) / k
                h += k * n
            s += n
        return out

    def at(self, s: Array, d: Array) -> tuple[Array, Array, Array]:
        """Where the path is at s, d to the left of it; it goes on straight before and after."""
        s = np.asarray(s, float)
        x, y, h = np.zeros_like(s), np.zeros_like(s), np.zeros_like(s)
        starts = self.starts()
        for i, ((s0, x0, y0, h0), (n, k)) in enumerate(zip(starts, self.parts, strict=True)):
            on = (s >= s0) if i else np.ones_like(s, bool)
            u = s[on] - s0
            if k == 0:
                x[on], y[on], h[on] = x0 + u * np.cos(h0), y0 + u * np.sin(h0), h0
            else:
                v = np.clip(u, 0, n)
                e = h0 + k * v
                x[on] = x0 + (np.sin(e) - np.sin(h0)) / k + (u - v) * np.cos(e)
                y[on] = y0 - (np.cos(e) - np.cos(h0)) / k + (u - v) * np.sin(e)
                h[on] = e
        return x - d * np.sin(h), y + d * np.cos(h), h


@dataclass
class Lane:
    """One lane, counted from the middle outward; the mark is that of its outer border."""

    kind: str = "driving"
    width: float = W
    mark: str = "broken"
    pred: int | None = None
    succ: int | None = None


@dataclass
class Section:
    """A stretch of a road with the same lanes."""

    s: float
    left: list[Lane]
    right: list[Lane]
    middle: list[tuple[float, str]] = field(default_factory=lambda: [(0.0, "broken")])


def mark(kind: str, s: float = 0.0) -> str:
    """A line."""
    return f'<roadMark sOffset="{s:.3f}" type="{kind}" weight="standard" color="white" width="0.12"/>'


def lane_text(i: int, lane: Lane, first: bool, last: bool, ends: tuple[bool, bool]) -> str:
    """One lane; `ends`: whether the road goes on before and after."""
    link = ""
    before = lane.pred if lane.pred is not None else (i if (not first or ends[0]) else None)
    after = lane.succ if lane.succ is not None else (i if (not last or ends[1]) else None)
    if before:
        link += f'<predecessor id="{before}"/>'
    if after:
        link += f'<successor id="{after}"/>'
    return (
        f'<lane id="{i}" type="{lane.kind}" level="false"><link>{link}</link>'
        f'<width sOffset="0" a="{lane.width}" b="0" c="0" d="0"/>{mark(lane.mark)}</lane>'
    )


def road(  # noqa: PLR0917
    rid: int,
    path: Path,
    sections: list[Section],
    side: int,
    kind: str = "rural",
    speed: float | None = 60,
    unit: str = "mph",
    junction: int = -1,
    pred: str = "",
    succ: str = "",
    offset: float = 0.0,
    signals: str = "",
    objects: str = "",
    ends: tuple[bool, bool] = (False, False),
) -> str:
    """The text of one road."""
    geo = ""
    for (s, x, y, h), (n, k) in zip(path.starts(), path.parts, strict=True):
        shape = "<line/>" if k == 0 else f'<arc curvature="{k:.10f}"/>'
        geo += f'<geometry s="{s:.6f}" x="{x:.6f}" y="{y:.6f}" hdg="{h:.8f}" length="{n:.6f}">{shape}</geometry>'
    lanes = f'<laneOffset s="0" a="{offset}" b="0" c="0" d="0"/>'
    for n, sec in enumerate(sections):
        first, last = n == 0, n == len(sections) - 1
        left = [lane_text(i + 1, x, first, last, ends) for i, x in enumerate(sec.left)][::-1]
        right = [lane_text(-i - 1, x, first, last, ends) for i, x in enumerate(sec.right)]
        lanes += f'<laneSection s="{sec.s:.3f}">'
        lanes += f"<left>{''.join(left)}</left>" if left else ""
        lanes += '<center><lane id="0" type="none" level="false">'
        lanes += "".join(mark(m, s) for s, m in sec.middle) + "</lane></center>"
        lanes += f"<right>{''.join(right)}</right>" if right else ""
        lanes += "</laneSection>"
    limit = "" if speed is None else f'<speed max="{speed:g}" unit="{unit}"/>'
    rule = "LHT" if side == GB else "RHT"
    return (
        f'<road name="r{rid}" length="{path.length:.6f}" id="{rid}" junction="{junction}" rule="{rule}">'
        f'<link>{pred}{succ}</link><type s="0" type="{kind}">{limit}</type>'
        f"<planView>{geo}</planView><elevationProfile/><lateralProfile/><lanes>{lanes}</lanes>"
        f"<objects>{objects}</objects><signals>{signals}</signals></road>\n"
    )


def whole(*texts: str) -> str:
    """The file."""
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<OpenDRIVE><header revMajor="1" revMinor="6" name="eleventh" '
        'version="1" north="0" south="0" east="0" west="0"/>\n' + "".join(texts) + "</OpenDRIVE>\n"
    )


def signal(  # noqa: PLR0917
    sid: str, s: float, t: float, kind: str, country: str, way: str = "+", name: str = "", dynamic: bool = False
) -> str:
    """A sign or light."""
    return (
        f'<signal s="{s:.3f}" t="{t:.3f}" id="{sid}" name="{name or sid}" dynamic="{"yes" if dynamic else "no"}" '
        f'orientation="{way}" zOffset="2.2" country="{country}" type="{kind}" subtype="-1" value="-1" '
        'height="0.7" width="0.7"/>'
    )


def light(sid: str, s: float, t: float, way: str = "+") -> str:
    """A traffic light."""
    return signal(sid, s, t, "1000001", "OpenDRIVE", way, "traffic_light", True)


def stop_line(sid: str, s: float, t: float, way: str = "+", width: float = 3.3) -> str:
    """A stop line."""
    return (
        f'<object id="{sid}" type="stopLine" name="stopline" s="{s:.3f}" t="{t:.3f}" zOffset="0" hdg="0" '
        f'orientation="{way}" length="0.3" width="{width}" height="0.01"/>'
    )


def crossing(sid: str, s: float, across: float, name: str = "zebra", depth: float = 3.0, t: float = 0.0) -> str:  # noqa: PLR0917
    """A crossing for those on foot."""
    return (
        f'<object id="{sid}" type="crosswalk" name="{name}" s="{s:.3f}" t="{t}" zOffset="0" hdg="0" '
        f'orientation="none" length="{depth}" width="{across}" height="0.01"/>'
    )


def simple(  # noqa: PLR0917
    side: int,
    parts: list[tuple[float, float]],
    kind: str = "rural",
    speed: float | None = 60,
    middle: list[tuple[float, str]] | None = None,
    near: int = 1,
    far: int = 1,
    verge: str = "",
    median: float = 0.0,
    w: float = W,
    signals: str = "",
    objects: str = "",
    unit: str = "",
    x: float = 0.0,
    h: float = 0.0,
) -> tuple[str, Path]:
    """One road: `near` lanes with its direction, `far` lanes against it, a verge (sidewalk, shoulder), a median."""
    path = Path(x, 0.0, h, parts)

    def lanes(n: int) -> list[Lane]:
        out = [Lane("median", median, "solid")] if median and n else []
        out += [Lane("driving", w, "broken" if i < n - 1 else "solid") for i in range(n)]
        if verge and n:
            out.append(Lane(verge, 2.0 if verge == "sidewalk" else 3.2, "none"))
        return out

    ahead, back = lanes(near), lanes(far)
    left, right = (ahead, back) if side == GB else (back, ahead)
    sec = Section(0.0, left, right, middle or [(0.0, "solid" if median or not far else "broken")])
    unit = unit or ("mph" if side == GB else "km/h")
    text = road(1, path, [sec], side, kind, speed, unit, signals=signals, objects=objects)
    return whole(text), path
