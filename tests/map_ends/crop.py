"""Judges traffic once on the whole road, once as if log and map had been cut out of it, and pairs the verdicts."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from drivelint import catalogue
from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive, cut_batches
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from drivelint.sql import store
from tests import cropping
from tests.perception.compare import LEAST_S, write
from tests.perception.traffic import tracks

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from drivelint.road.map_reader import MapTables
    from tests.perception.traffic import Track
    from tests.sumo.world import Files

RULES: Final = (
    "criticality.thw", "criticality.ttc", "stvo.rg1", "stvo.rg6", "stvo.ri2", "ukhc.overtake-zone", "ukhc.r126.*", "ukhc.r133.*",
    "ukhc.r162.*", "ukhc.r163.*", "ukhc.r168.*", "ukhc.r264.*", "ukhc.r268.*",
)  # fmt: skip
"""The rules that ask who is ahead, behind, beside, oncoming, or was passed."""
_EDGE_M: Final = 10.0
_RANK: Final = "list_position(['error', 'fail', 'unknown', 'pass', 'not_applicable'], verdict)"
# a rule's verdict at a reference point, or the worst one of its episodes
_WORST: Final = f"""
    SELECT drive_id, rule_id, coalesce(profile, ''), coalesce(t_ref_ns, -1),
        min({{'rank': {_RANK}, 'verdict': verdict, 'reason': reason}}) AS worst
    FROM verdict WHERE NOT (verdict = 'not_applicable' AND t_ref_ns IS NULL) GROUP BY ALL ORDER BY ALL
"""
Key = tuple[str, str, str, int]  # ego, rule, profile, time of the reference point (-1: none)


class Verdict(NamedTuple):
    """A verdict and its reason."""

    verdict: str
    reason: str | None


NOT_APPLICABLE: Final = Verdict("not_applicable", None)


class Pair(NamedTuple):
    """What is said on the whole road, and on a part of it."""

    whole: Verdict
    part: Verdict

    @property
    def contradicts(self) -> bool:
        """Whether a breach is none on the part, or one only there.

        A rule that does not apply on the part, because nobody is left there, contradicts nothing but a breach.
        """
        said = {self.whole.verdict, self.part.verdict}
        return len(said) == 2 and "fail" in said and "unknown" not in said


def between(first: float, last: float) -> cropping.Inside:
    """Return what of the plane lies between two values of x, in metres."""
    return lambda x, _y: (x >= first) & (x <= last)


def compared(
    files: Files,
    folder: Path,
    span: tuple[float, float],
    hand: str,
    *,
    max_egos: int | None = None,
    rules: Sequence[str] = RULES,
) -> dict[Key, Pair]:
    """Return the verdicts of those who drive on the part between two values of x for a while (at most so many), each as ego."""
    inside = between(*span)
    road = load_map(MapSource(files.map.name, files.map.read_bytes()), handedness=hand)
    part = cropping.cropped(road, f"{road.environment_id} {span[0]:.0f} {span[1]:.0f}", inside)
    everybody = tracks(files.log, files.routes)
    # a lane ends up to a metre before the edge, for it is cut between two of its points
    recorded = between(span[0] + 1.5, span[1] - 1.5)
    there = [track.take(recorded(track.x, track.y)) for track in everybody]
    # the whole of the ego's box is on the map
    on = between(span[0] + _EDGE_M, span[1] - _EDGE_M)
    egos = [track.take(on(track.x, track.y)) for track in there]
    egos = [track for track in egos if len(track.t_ns) and (track.t_ns[-1] - track.t_ns[0]) * 1e-9 >= LEAST_S]
    if max_egos is not None and len(egos) > max_egos:
        egos = [egos[k] for k in np.linspace(0, len(egos) - 1, max_egos).astype(int)]
    whole = worst_verdicts(_drives(egos, everybody, folder / "whole", files.map, road), rules)
    less = worst_verdicts(_drives(egos, there, folder / "part", files.map, part), rules)
    return {
        key: Pair(whole.get(key, NOT_APPLICABLE), less.get(key, NOT_APPLICABLE))
        for key in sorted(whole.keys() | less.keys())
    }


def _drives(egos: Sequence[Track], tracks: Sequence[Track], folder: Path, road: Path, on: MapTables) -> Iterator[Drive]:
    """Yield one drive per ego, with what the others do meanwhile; its id is the ego's."""
    for ego in egos:
        now = [t.take((t.t_ns >= ego.t_ns[0]) & (t.t_ns <= ego.t_ns[-1])) for t in tracks if t.actor_id != ego.actor_id]
        write(folder / ego.actor_id, ego, [track for track in now if len(track.t_ns)], road, None)
        yield Drive(read_trace(folder / ego.actor_id, IngestOptions(in_sight=True)), on)


def worst_verdicts(drives: Iterator[Drive], rules: Sequence[str]) -> dict[Key, Verdict]:
    """Return the verdicts of these drives, by ego."""
    with store.connect() as con:
        store.insert(con, "profile", profile_table(load_profiles(), ()))
        session = JudgingSession(con, catalogue.select_rules(catalogue.load_rules(), tuple(rules), ()), {}, None)
        names: dict[str, str] = {}

        def noted() -> Iterator[Drive]:
            for drive in drives:
                actor = drive.trace.tables["actor"]
                names[drive.trace.drive_id] = actor.filter(actor["is_ego"])["actor_id"][0].as_py()
                yield drive

        for batch in cut_batches(noted()):
            session.judge([one for one in batch if isinstance(one, Drive)])
        rows = con.execute(_WORST).fetchall()
    return {(names[drive], *key): Verdict(worst["verdict"], worst["reason"]) for drive, *key, worst in rows}


def count_pairs(pairs: dict[Key, Pair]) -> dict[str, Counter[tuple[str, str]]]:
    """Return how often each pair of verdicts occurs, by rule."""
    found: dict[str, Counter[tuple[str, str]]] = defaultdict(Counter)
    for (_, rule, *_), pair in pairs.items():
        found[rule][pair.whole.verdict, pair.part.verdict] += 1
    return dict(sorted(found.items()))
