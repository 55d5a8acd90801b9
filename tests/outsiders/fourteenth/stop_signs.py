"""Stop signs."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.places import LINE, stop_arm
from tests.outsiders.fourteenth.scenes import Points, turn


def stop_signs_a() -> Iterator[Drive]:
    gb = stop_arm("gb")
    de = stop_arm("de")
    r = "ukhc.r171.stop-sign"
    rin = "stvo.rin1"
    near = "performance.precise-stop"

    def to(line_gap: float, wait: float) -> Points:
        # from 40 m at 10 m/s: 3 s steady, then down to a halt with the front `line_gap` before the line
        way = LINE - 2.25 - line_gap - 40.0 - 30.0
        t = 3.0 + way / 5.0
        return ((0, 10), (3, 10), (t, 0), (t + wait + 1.0, 0), (t + wait + 4.0, 8))

    yield turn(
        "stop-halts",
        "halts 0.3 m before the line for 2 s",
        gb,
        "N",
        to(0.3, 2.0),
        [(r, "pass", "halt"), (near, "pass", "0.3 m")],
    )
    yield turn(
        "stop-rolls",
        "rolls over the line at 1.2 m/s",
        gb,
        "N",
        ((0, 10), (3, 10), (10.4, 1.2), (12.5, 1.2), (15, 8)),
        [(r, "fail", "1.2 m/s")],
    )
    yield turn(
        "stop-short", "halts 1.8 m before the line", gb, "N", to(1.8, 2.0), [(near, "fail", "1.8 m, 0.5 allowed")]
    )
    yield turn(
        "stop-over",
        "halts with its front 1.6 m over the line",
        gb,
        "N",
        to(-1.6, 2.0),
        [(r, "fail", "no halt before the line")],
    )
    yield turn(
        "stop-early-roll",
        "halts 14 m before the line and then rolls over it",
        gb,
        "N",
        ((0, 10), (3, 10), (9.3, 0), (12, 0), (14, 4), (20, 4), (22, 8)),
        [(r, "fail", "halt 14 m off, over the line at 4 m/s")],
        seconds=26.0,
    )
    yield turn(
        "stop-de-2s", "halts 0.4 m before the line for 2 s", de, "N", to(0.4, 2.0), [(rin, "pass", "2 s")], hz=20.0
    )


def stop_signs_b() -> Iterator[Drive]:
    de = stop_arm("de")
    rin = "stvo.rin1"
    yield turn(
        "stop-de-rolls",
        "rolls over the line at 2 m/s",
        de,
        "E",
        ((0, 10), (3, 10), (9.6, 2.0), (12.5, 2.0), (15, 8)),
        [(rin, "fail", "2 m/s")],
    )


def stop_signs() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from stop_signs_a()
    yield from stop_signs_b()
