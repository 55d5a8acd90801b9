"""The report's section on overtakes (safe distances ahead, danger-space assertions per stage, zones) and on opportunities.

Opportunities to overtake, taken and not taken, are shown by the distance ahead that was available.
"""

from __future__ import annotations

import statistics
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

from drivelint.report.html.svg import Axis, percent, round_step, svg_number
from drivelint.result.text import number, seconds

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from drivelint.result.text import Row

MAX_OVERTAKES: Final = 60
"""The page shows this many overtakes: those with the least spare distance in any profile."""
ASSERTION_TITLES: Final = (
    "Vehicle being passed outside the ego's danger space",
    "Oncoming vehicle outside the ego's danger space",
    "Ego outside the oncoming vehicle's danger space",
    "The two danger spaces apart",
)
"""The conditions that the runtime assertions require, in the order of `overtake_record.stretches`."""
_STAGES: Final = ("pulling_out", "passing", "cutting_in")
_VERDICT_BY_ASSERTION_WORD: Final = {"nobody": "not_applicable"}
_LEAST_LABEL_DISTANCE_PERCENT: Final = 20.0  # percent: the width of a label on a phone
_LEAST_BAND_WIDTH_PERCENT: Final = 0.6  # percent: the least width of a band
_VERDICTS_WORST_FIRST: Final = ("fail", "unknown", "pass", "nobody")
_SPARE_TIMES_AT_ZONE_STARTS_S: Final = (0.0, 0.5, 2.5)  # the spare time at which zones B, C and D begin
_DOT_SHAPE_PER_PROFILE: Final = ("circle", "square", "diamond", "triangle", "cross")
_PLOT_W, _PLOT_H = 560, 400
_NAMES_SHOWN_UP_TO_N_OVERTAKES: Final = 10
_CELL_OF_PROFILE_NOT_COMPUTED: Final = {"zone": None, "sda_m": None, "spare_m": None, "reason": "not computed"}
_TIME_COLUMNS: Final = ("t0_ns", "t1_ns", "t2_ns", "t3_ns")
MOST_SHOWN_SAFE_DISTANCE_AHEAD_M: Final = 2000.0
"""A longer safe distance ahead only shows that the ego was hardly faster than the vehicle being passed."""
_BARS_W, _BARS_H = 560, 230
_HISTOGRAM_BINS: Final = 12
_PREFERRED_PROFILE: Final = "nominal"


def overtake_views(
    records: Sequence[Row], starts: Mapping[str, int], judged_profiles: Collection[str]
) -> dict[str, Any] | None:
    """Return the table of overtakes and the zone plot from rows of `overtake_record`; None if there are no overtakes.

    `judged_profiles`: the profiles with verdicts; any other profile is a what-if.
    """
    records = [row for row in records if row["profiles"] or row["stretches"]]
    if not records:
        return None
    pairs = {(p["style"], p["profile"]) for row in records for p in row["profiles"]}
    profiles = [profile for _, profile in sorted(pairs)]
    picked = sorted(records, key=_least_spare_sort_key)[:MAX_OVERTAKES]
    listed = sorted(picked, key=lambda r: (r["drive_id"], r["ego_id"], r["occurrence"]))
    return {
        "profiles": profiles,
        "what_ifs": sorted(set(profiles) - set(judged_profiles)),
        "overtakes": [_overtake_view(row, profiles, starts.get(row["drive_id"]) or 0) for row in listed],
        "n": len(records),
        "zones": _zone_plot(listed, profiles, starts),
    }


def _least_spare_sort_key(row: Row) -> tuple[float, str, str, int]:
    spare = [max(p["spare_m"], -MOST_SHOWN_SAFE_DISTANCE_AHEAD_M) for p in row["profiles"] if p["spare_m"] is not None]
    return min(spare, default=float("inf")), row["drive_id"], row["ego_id"], row["occurrence"]


def _overtake_view(row: Row, profiles: Sequence[str], start_ns: int) -> dict[str, Any]:
    cells = {p["profile"]: p for p in row["profiles"]}
    stages = [stage for stage in _STAGES if any(s["stage"] == stage for s in row["stretches"])]
    clock = Axis(row["t0_ns"], max(row["t_end_ns"], row["t0_ns"] + 1), 0.0, 100.0)
    return {
        "row": row,
        "time": seconds(row["t0_ns"], start_ns),
        "cells": [_profile_cell(cells.get(profile, _CELL_OF_PROFILE_NOT_COMPUTED)) for profile in profiles],
        "stages": stages,
        "rows": [_assertion_row(n, row["stretches"], stages, clock) for n in range(len(ASSERTION_TITLES))]
        if stages
        else [],
        "times": _axis_labels(
            [
                (clock.at(row[at]), f"{at[:2]} {(row[at] - start_ns) / 1e9:.1f}")
                for at in _TIME_COLUMNS
                if row[at] is not None
            ]
        ),
        "bounds": _stage_spans(row["stretches"], clock),
    }


def _profile_cell(p: Row) -> Row:
    """Return a profile's row with `is_far`: its safe distance ahead exceeds `MOST_SHOWN_SAFE_DISTANCE_AHEAD_M`, so it is not printed."""
    return {**p, "is_far": p["sda_m"] is not None and p["sda_m"] > MOST_SHOWN_SAFE_DISTANCE_AHEAD_M}


def _axis_labels(times: Sequence[tuple[float, str]]) -> list[tuple[str, str]]:
    """Return positions and labels on the axis; labels that would overlap are joined at the position of the first."""
    labels: list[tuple[float, str]] = []
    for at, label in times:
        if labels and at - labels[-1][0] < _LEAST_LABEL_DISTANCE_PERCENT:
            labels[-1] = labels[-1][0], f"{labels[-1][1]}, {label}"
        else:
            labels.append((at, label))
    return [(percent(at), label) for at, label in labels]


def _stage_spans(stretches: Sequence[Row], clock: Axis) -> list[tuple[str, str, str]]:
    """Return the stages, each as name, position and width."""
    spans = []
    for stage in _STAGES:
        parts = [s for s in stretches if s["stage"] == stage]
        if parts:
            a, b = clock.at(min(s["t_start_ns"] for s in parts)), clock.at(max(s["t_end_ns"] for s in parts))
            spans.append((stage, percent(a), percent(b - a)))
    return spans


def _assertion_row(n: int, stretches: Sequence[Row], stages: Sequence[str], clock: Axis) -> dict[str, Any]:
    """Return assertion `n`: its verdict and greatest depth per stage, and its verdicts over time as bands in percent."""
    cells = []
    for stage in stages:
        outcomes = [(s["said"][n], s["worst_m"][n]) for s in stretches if s["stage"] == stage]
        verdict = min((word for word, _ in outcomes), key=_VERDICTS_WORST_FIRST.index)
        deep = max((m for _, m in outcomes if m is not None), default=None)
        cells.append((_VERDICT_BY_ASSERTION_WORD.get(verdict, verdict), deep))
    runs: list[list[Any]] = []
    for s in stretches:
        word = _VERDICT_BY_ASSERTION_WORD.get(s["said"][n], s["said"][n])
        if runs and runs[-1][0] == word:
            runs[-1][2] = s["t_end_ns"]
        else:
            runs.append([word, s["t_start_ns"], s["t_end_ns"]])
    ends = [start for _, start, _ in runs[1:]] + [runs[-1][2]]
    bands = []
    for (word, start, last), end in zip(runs, ends, strict=True):
        a, b = clock.at(start), min(max(clock.at(max(last, end)), clock.at(start) + _LEAST_BAND_WIDTH_PERCENT), 100.0)
        bands.append(
            (
                word,
                percent(min(a, 100.0 - _LEAST_BAND_WIDTH_PERCENT)),
                percent(b - min(a, 100.0 - _LEAST_BAND_WIDTH_PERCENT)),
            )
        )
    return {"title": ASSERTION_TITLES[n], "cells": cells, "bands": bands}


def _zone_plot(records: Sequence[Row], profiles: Sequence[str], starts: Mapping[str, int]) -> dict[str, Any] | None:
    """Return the zone plot: areas, axes, one dot per overtake and profile, names, and the closing speed assumed for the areas."""
    points = [
        (row, p)
        for row in records
        for p in row["profiles"]
        if p["da_m"] is not None and p["sda_m"] is not None and p["sda_m"] <= MOST_SHOWN_SAFE_DISTANCE_AHEAD_M
    ]
    n_missing = sum(len(row["profiles"]) for row in records) - len(points)
    if not points:
        return None
    far = 1.08 * max(p[name] for _, p in points for name in ("da_m", "sda_m"))
    x, y = Axis(0.0, far, 48.0, _PLOT_W - 12.0), Axis(0.0, far, _PLOT_H - 40.0, 10.0)
    closing = [p["spare_m"] / p["spare_s"] for _, p in points if p["spare_s"]]
    v = statistics.median(closing) if closing else 0.0
    shapes = {
        profile: _DOT_SHAPE_PER_PROFILE[min(n, len(_DOT_SHAPE_PER_PROFILE) - 1)] for n, profile in enumerate(profiles)
    }
    rows = {id(row): row for row, _ in points}.values()
    return {
        "areas": _zone_areas(x, y, far, v),
        "x_ticks": x.ticks(7),
        "y_ticks": y.ticks(7),
        "dots": [
            {
                "x": svg_number(x.at(p["sda_m"])),
                "y": svg_number(y.at(p["da_m"])),
                "shape": shapes[p["profile"]],
                "zone": p["zone"],
                "title": f"{row['drive_id']} at {seconds(row['t0_ns'], starts.get(row['drive_id']))}, {p['profile']}: distance ahead "
                f"{number(p['da_m'], 'm')}, required more than {number(p['sda_m'], 'm')}, zone {p['zone'] or 'unknown'}",
            }
            for row, p in points
        ],
        "names": [_plot_label(row, x, y) for row in rows] if len(rows) <= _NAMES_SHOWN_UP_TO_N_OVERTAKES else [],
        "shapes": list(shapes.items()),
        "speed": number(v, "m/s"),
        "same_speed": bool(closing) and max(closing) - min(closing) < 0.05 * v,
        "missing": n_missing,
    }


def _plot_label(row: Row, x: Axis, y: Axis) -> tuple[str, str, str]:
    """Return position and name of an overtake: at the right edge, above the height of its dots."""
    da = next(p["da_m"] for p in row["profiles"] if p["da_m"] is not None and p["sda_m"] is not None)
    return svg_number(x.end - 4), svg_number(y.at(da) - 11), row["drive_id"]


def _zone_areas(x: Axis, y: Axis, far: float, v: float) -> list[tuple[str, str, tuple[str, str] | None]]:
    """Return the zones from bottom to top: name, path, and the position of its letter (None if the zone is too thin for it)."""
    floors = [-far, *(v * s for s in _SPARE_TIMES_AT_ZONE_STARTS_S), 2 * far]
    areas: list[tuple[str, str, tuple[str, str] | None]] = []
    for zone, low, high in zip("ABCD", floors[:-1], floors[1:], strict=True):
        corners = [(0.0, low), (far, low + far), (far, high + far), (0.0, high)]
        path = "M" + " ".join(f"{svg_number(x.at(a))},{svg_number(y.at(b))}" for a, b in corners) + "Z"
        thick = min(high, far) - max(low, 0.0) if zone != "A" else far
        a, b = (0.7 * far, 0.1 * far) if zone == "A" else (0.04 * far, 0.04 * far + (low + min(high, far)) / 2)
        letter = (svg_number(x.at(a)), svg_number(y.at(b) + 6)) if thick > 0.03 * far and b < 0.97 * far else None
        areas.append((zone, path, letter))
    return areas


def overtaking_opportunities(records: Sequence[Row]) -> dict[str, Any] | None:
    """Return a histogram of `opportunity_record` for one profile, and for each profile the numbers taken and not taken by zone.

    Return None if there are no opportunities.
    """
    if not records:
        return None
    profiles = [name for _, name in sorted({(row["style"], row["profile"]) for row in records})]
    profile = _PREFERRED_PROFILE if _PREFERRED_PROFILE in profiles else profiles[0]
    opportunities = [row for row in records if row["profile"] == profile]
    known_opportunities = [row for row in opportunities if row["da_m"] is not None]
    bars, x_ticks, y_ticks = _histogram_bars_and_ticks(known_opportunities) if known_opportunities else ([], [], [])
    return {
        "profile": profile,
        "n": len(opportunities),
        "unknown": len(opportunities) - len(known_opportunities),
        "bars": bars,
        "x_ticks": x_ticks,
        "y_ticks": y_ticks,
        "rows": [_opportunity_counts_by_zone(name, records) for name in profiles],
    }


def _opportunity_counts_by_zone(
    profile: str, records: Sequence[Row]
) -> tuple[str, list[tuple[int, int]], tuple[int, int]]:
    """Return a profile with the numbers of opportunities taken and not taken in zones A to D, and in an unknown zone."""
    n = Counter((row["zone"], row["taken"]) for row in records if row["profile"] == profile)
    *known_counts, unknown = ((n[zone, True], n[zone, False]) for zone in (*"ABCD", None))
    return profile, known_counts, unknown


def _histogram_bars_and_ticks(
    opportunities: Sequence[Row],
) -> tuple[list[dict[str, str]], list[tuple[str, str]], list[tuple[str, str]]]:
    far = max(row["da_m"] for row in opportunities)
    width = round_step(max(far, 10.0) / _HISTOGRAM_BINS)
    n = int(far // width) + 1
    counts = [[0, 0] for _ in range(n)]
    for row in opportunities:
        counts[int(row["da_m"] // width)][0 if row["taken"] else 1] += 1
    x = Axis(0.0, n * width, 44.0, _BARS_W - 12.0)
    y = Axis(0.0, float(max(sum(pair) for pair in counts)), _BARS_H - 38.0, 10.0)
    bars = []
    for k, (n_taken, n_passed) in enumerate(counts):
        a, b = x.at(k * width), x.at((k + 1) * width)
        low, middle, high = y.at(0), y.at(n_taken), y.at(n_taken + n_passed)
        bars.append(
            {
                "x": svg_number(a + 1),
                "w": svg_number(b - a - 2),
                "taken_y": svg_number(middle),
                "taken_h": svg_number(low - middle),
                "passed_y": svg_number(high),
                "passed_h": svg_number(middle - high),
                "words": f"{k * width:g} to {(k + 1) * width:g} m: {n_taken} taken, {n_passed} not taken",
            }
        )
    whole = [(place, label.split(".")[0]) for place, label in y.ticks(4) if float(label) == int(float(label))]
    return bars, x.ticks(8), whole
