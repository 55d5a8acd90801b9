"""Opportunities to overtake, taken and not taken, by the distance ahead that there was."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from drivelint.report.html.svg import Axis, num, round_step

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.text import Row

_WIDTH, _HEIGHT = 560, 230
_BINS: Final = 12
_PREFERRED: Final = "nominal"


def overtaking_opportunities(records: Sequence[Row]) -> dict[str, Any] | None:
    """Return the histogram of the rows of `opportunity_record` for one profile, and per profile how many were taken and not, by zone.

    None: there are none.
    """
    if not records:
        return None
    profiles = [name for _, name in sorted({(row["style"], row["profile"]) for row in records})]
    profile = _PREFERRED if _PREFERRED in profiles else profiles[0]
    mine = [row for row in records if row["profile"] == profile]
    known = [row for row in mine if row["da_m"] is not None]
    bars, x_ticks, y_ticks = _bars(known) if known else ([], [], [])
    return {
        "profile": profile,
        "n": len(mine),
        "unknown": len(mine) - len(known),
        "bars": bars,
        "x_ticks": x_ticks,
        "y_ticks": y_ticks,
        "rows": [_row(name, records) for name in profiles],
    }


def _row(profile: str, records: Sequence[Row]) -> tuple[str, list[tuple[int, int]], tuple[int, int]]:
    """Return a profile with the numbers taken and not taken in zones A to D, and where the zone is not known."""
    mine = [row for row in records if row["profile"] == profile]

    def count(zone: str | None) -> tuple[int, int]:
        there = [row["taken"] for row in mine if row["zone"] == zone]
        return sum(there), len(there) - sum(there)

    return profile, [count(zone) for zone in "ABCD"], count(None)


def _bars(known: Sequence[Row]) -> tuple[list[dict[str, str]], list[tuple[str, str]], list[tuple[str, str]]]:
    far = max(row["da_m"] for row in known)
    width = round_step(max(far, 10.0) / _BINS)
    n = int(far // width) + 1
    counts = [[0, 0] for _ in range(n)]
    for row in known:
        counts[int(row["da_m"] // width)][0 if row["taken"] else 1] += 1
    x = Axis(0.0, n * width, 44.0, _WIDTH - 12.0)
    y = Axis(0.0, float(max(sum(pair) for pair in counts)), _HEIGHT - 38.0, 10.0)
    bars = []
    for k, (taken, passed) in enumerate(counts):
        a, b = x.at(k * width), x.at((k + 1) * width)
        low, middle, high = y.at(0), y.at(taken), y.at(taken + passed)
        bars.append(
            {
                "x": num(a + 1),
                "w": num(b - a - 2),
                "taken_y": num(middle),
                "taken_h": num(low - middle),
                "passed_y": num(high),
                "passed_h": num(middle - high),
                "words": f"{k * width:g} to {(k + 1) * width:g} m: {taken} taken, {passed} not taken",
            }
        )
    whole = [(place, label.split(".")[0]) for place, label in y.ticks(4) if float(label) == int(float(label))]
    return bars, x.ticks(8), whole
