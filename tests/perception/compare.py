"""Judges what was there and what was recorded of it, and counts verdicts that the recording turned into their opposite."""

from __future__ import annotations

import subprocess
import sys
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Final, NamedTuple

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq

from .recorder import recorded

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from .recorder import Recorder
    from .traffic import Track

_LIGHTS: Final = ("off", "left", "right")
_WORST: Final = """
    SELECT {ego} AS ego, rule_id, coalesce(profile, '') AS profile,
        min({{'rank': list_position(['error', 'fail', 'unknown', 'pass', 'not_applicable'], verdict), 'verdict': verdict}}).verdict
    FROM read_parquet($file) GROUP BY ALL ORDER BY ALL
"""
Key = tuple[str, str, str]  # ego, rule, profile
LEAST_S: Final = 15.0
"""Whoever is there for less is no ego."""


class Tally(NamedTuple):
    """Of one rule, or of several: pairs of verdicts, as (what was there, what was recorded) -> how many."""

    pairs: Counter[tuple[str, str]]

    def n(self, truth: Iterable[str], recording: Iterable[str]) -> int:
        """Return how many have one of these verdicts on what was there, and one of those on the recording."""
        return sum(self.pairs[a, b] for a in truth for b in recording)

    @property
    def decided(self) -> int:
        """How many what was there decides."""
        return self.n(("pass", "fail"), ("pass", "fail", "unknown", "not_applicable", "error"))

    @property
    def fails(self) -> int:
        """How many breaches there were."""
        return self.n(("fail",), ("pass", "fail", "unknown", "not_applicable", "error"))

    @property
    def decided_by_both(self) -> int:
        """How many of those the recording decides as well."""
        return self.n(("pass", "fail"), ("pass", "fail"))

    @property
    def false_passes(self) -> int:
        """How many breaches the recording calls a pass."""
        return self.n(("fail",), ("pass",))

    @property
    def missed(self) -> int:
        """How many breaches the recording calls not applicable."""
        return self.n(("fail",), ("not_applicable",))

    @property
    def false_fails(self) -> int:
        """How many fails of the recording are none."""
        return self.n(("pass", "not_applicable"), ("fail",))


def egos(tracks: Sequence[Track], max_egos: int | None) -> list[Track]:
    """Return who is long enough there to be an ego; of more than `max_egos` every so many-th."""
    found = [track for track in tracks if (track.t_ns[-1] - track.t_ns[0]) * 1e-9 >= LEAST_S]
    step = 1 if max_egos is None or len(found) <= max_egos else len(found) / max_egos
    return [found[int(k * step)] for k in range(min(len(found), max_egos or len(found)))]


def compared(  # noqa: PLR0917
    tracks: Sequence[Track],
    road: Path,
    folder: Path,
    recorders: Mapping[str, Recorder],
    max_egos: int | None,
    options: Sequence[str],
) -> tuple[dict[str, dict[str, Tally]], float]:
    """Judge what was there, once, and what each ego records of it; return by level a tally by rule, and the hours that egos drove."""
    chosen = egos(tracks, max_egos)
    for number, ego in enumerate(chosen):
        write(folder / "truth" / ego.actor_id, ego, _around(ego, tracks), road, None)
        objects = [track for track in tracks if track.actor_id != ego.actor_id]
        for level, recorder in recorders.items():
            seen = _split(recorded(ego, objects, recorder, number))
            write(folder / level / ego.actor_id, *seen, road, recorder.range_m)
    truth = _worst_verdicts(folder / "truth", options)
    tallies = {level: _tallies(truth, _worst_verdicts(folder / level, options)) for level in recorders}
    hours = sum(float(ego.t_ns[-1] - ego.t_ns[0]) for ego in chosen) / 3.6e12
    return tallies, hours


def _tallies(truth: Mapping[Key, str], recording: Mapping[Key, str]) -> dict[str, Tally]:
    """Return by rule how its verdicts on what was there became those on the recording."""
    pairs: dict[str, Counter[tuple[str, str]]] = defaultdict(Counter)
    for key in truth.keys() | recording.keys():
        pairs[key[1]][truth.get(key, "not_applicable"), recording.get(key, "not_applicable")] += 1
    return {rule: Tally(pairs[rule]) for rule in sorted(pairs)}


def _around(ego: Track, tracks: Sequence[Track]) -> list[Track]:
    """Return the others while the ego is there."""
    first, last = ego.t_ns[0], ego.t_ns[-1]
    cut = [t.take((t.t_ns >= first) & (t.t_ns <= last)) for t in tracks if t.actor_id != ego.actor_id]
    return [track for track in cut if len(track.t_ns)]


def _split(tracks: Sequence[Track]) -> tuple[Track, list[Track]]:
    return tracks[0], list(tracks[1:])


def write(folder: Path, ego: Track, objects: Sequence[Track], road: Path, range_m: float | None) -> None:
    """Write a drive as a folder of Parquet tables."""
    folder.mkdir(parents=True)
    (folder / "map.xodr").write_bytes(road.read_bytes())
    everybody = [ego, *objects]
    actors = {
        "actor_id": pa.array([t.actor_id for t in everybody]),
        "actor_class": pa.array([t.kind for t in everybody], pa.string()),
        "length_m": pa.array([t.length for t in everybody]),
        "width_m": pa.array([t.width for t in everybody]),
        "is_ego": pa.array([t is ego for t in everybody]),
    }
    pq.write_table(pa.table(actors), folder / "actor.parquet")
    states = [
        pa.table(
            {
                "actor_id": pa.array([t.actor_id] * len(t.t_ns)),
                "t_ns": t.t_ns,
                "x_m": t.x,
                "y_m": t.y,
                "yaw_rad": t.yaw,
                "vx_mps": t.vx,
                "vy_mps": t.vy,
                "indicator": pa.array([_LIGHTS[k] for k in t.indicator]),
                "brake_light": pa.array(["on" if on else "off" for on in t.brake]),
            }
        )
        for t in everybody
    ]
    pq.write_table(pa.concat_tables(states), folder / "actor_state.parquet")
    if range_m is not None:
        pq.write_table(pa.table({"sensor_range_m": [range_m]}), folder / "data_log.parquet")


def _worst_verdicts(folder: Path, options: Sequence[str]) -> dict[Key, str]:
    """Check the drives of a folder; return the worst verdict by ego, rule and profile."""
    out = folder.with_name(f"{folder.name}.out")
    command = [sys.executable, "-m", "drivelint", "check", str(folder), "--rules", "all", "--ignore", "status:draft"]
    command += ["--fail-on", "never", "--no-annotate", "--quiet", "--out", str(out), *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode not in {0, 3}:
        raise RuntimeError(f"exit {done.returncode}: {done.stderr}")
    with duckdb.connect() as con:
        # a drive's id is its folder's name with a digest behind it
        ego = "regexp_replace(drive_id, '-[0-9a-f]{8}$', '')"
        rows = con.execute(_WORST.format(ego=ego), {"file": str(out / "verdicts.parquet")}).fetchall()
    return {(ego, rule, profile): verdict for ego, rule, profile, verdict in rows}
