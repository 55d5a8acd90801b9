"""Compares the German rules with commonroad-stl-monitor, says which differences are explained, and prints the figures."""

from __future__ import annotations

import sys
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from .kinds import Kind, kinds, load_kinds
from .scenarios import LIMITS_KMH, public_scenarios, scenario_kinds, with_speed_limit
from .sides import Pair, our_result, pairs, peer_result

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path


class Row(NamedTuple):
    """The figures of a rule: of the pairs that the peer decides, how many ours decides, in part or whole, and how these compare."""

    rule: str
    pairs: int
    theirs: int
    ours_too: int
    partly: int
    equal: int
    explained: int
    unexplained: int


def compared(python: Path, folder: Path, scenarios: Sequence[Path]) -> tuple[list[Pair], dict[str, str]]:
    """Run both sides on every scenario and its twin with a limit; return all pairs, and why the peer has no result, by scenario."""
    found: list[Pair] = []
    without: dict[str, str] = {}
    for part in ("limited", "theirs", "ours"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    todo = [(scenario, kind) for scenario in scenarios for kind in scenario_kinds(scenario)]
    for scenario in scenarios:
        limited = (with_speed_limit(scenario, limit, folder / "limited") for limit in LIMITS_KMH)
        todo += [(twin, "limited") for twin in limited if twin]
    for scenario, kind in todo:
        name = f"{scenario.stem}.{kind}"
        print(f"... {name}", file=sys.stderr, flush=True)
        theirs = peer_result(python, scenario, kind, folder / "theirs" / f"{name}.json")
        if isinstance(theirs, str):
            without[name] = theirs
        found += pairs(scenario, kind, our_result(scenario, kind, folder / "ours" / name), theirs)
    return found, without


def table(compared_pairs: Iterable[Pair], known_kinds: Sequence[Kind]) -> list[Row]:
    """Return the figures by rule, and their sums."""
    by_rule: dict[str, list[Pair]] = {}
    for pair in compared_pairs:
        by_rule.setdefault(pair.rule + (" with a limit" if "+" in pair.scenario else ""), []).append(pair)
    by_rule = dict(sorted(by_rule.items()))
    by_rule["all"] = [pair for several in by_rule.values() for pair in several]
    rows = []
    for rule, several in by_rule.items():
        decided = [pair for pair in several if pair.peer_result]
        differ = [pair for pair in decided if pair.differ]
        explained = sum(bool(kinds(pair, known_kinds)) for pair in differ)
        both = sum(pair.both_decide for pair in decided)
        rows.append(
            Row(
                rule,
                len(several),
                len(decided),
                both,
                sum(not pair.ours_decides and bool(pair.n_judged) for pair in decided),
                both - len(differ),
                explained,
                len(differ) - explained,
            )
        )
    return rows


def report(compared_pairs: Sequence[Pair], without: dict[str, str]) -> tuple[str, bool]:
    """Return the text of a comparison, and whether its bars are met: 2 % unexplained, 70 % decided."""
    known_kinds = load_kinds()
    rows = table(compared_pairs, known_kinds)
    lines = [
        f"{'rule':18}{'pairs':>7}{'peer':>7}{'both':>7}{'in part':>9}{'equal':>7}{'explained':>11}{'unexplained':>13}"
    ]
    lines += [
        f"{r.rule:18}{r.pairs:7}{r.theirs:7}{r.ours_too:7}{r.partly:9}{r.equal:7}{r.explained:11}{r.unexplained:13}"
        for r in rows
    ]
    total = rows[-1]
    share_unexplained = total.unexplained / max(total.ours_too, 1)
    share_decided = total.ours_too / max(total.theirs, 1)
    lines += ["", f"differ without an explanation: {share_unexplained:.1%} of the pairs that both decide (at most 2 %)"]
    lines += [f"ours decides {share_decided:.1%} of the pairs that the peer decides (at least 70 %)"]
    recorded = [pair for pair in compared_pairs if pair.peer_result and "+" not in pair.scenario]
    share_recorded = sum(pair.ours_decides for pair in recorded) / max(len(recorded), 1)
    share_judged = sum(pair.ours_decides or pair.n_judged > 0 for pair in recorded) / max(len(recorded), 1)
    lines += [
        f"  without the limits that were added: {share_recorded:.1%}; or at least a part of the drive: {share_judged:.1%}"
    ]
    lines += ["", "differences:"]
    texts = {kind.name: kind for kind in known_kinds}
    counts = Counter(
        (pair.rule, (kinds(pair, known_kinds) or ["UNEXPLAINED"])[0]) for pair in compared_pairs if pair.differ
    )
    for (rule, name), n in sorted(counts.items()):
        lines.append(
            f"  {rule} {name}: {n}" + (f"; {texts[name].explanation} ({texts[name].clause})" if name in texts else "")
        )
    lines += [
        f"  UNEXPLAINED {pair.scenario} {pair.rule} vehicle {pair.vehicle}: "
        f"ours {pair.our_verdict} at {pair.fails[:5]}, peer {pair.peer_result} at {pair.breaks[:5]}"
        for pair in compared_pairs
        if pair.differ and not kinds(pair, known_kinds)
    ]
    lines += ["", "ours is unknown where the peer decides, by reason:"]
    unknown = Counter(
        (pair.rule, pair.reason or "no verdict")
        for pair in compared_pairs
        if pair.peer_result and not pair.ours_decides
    )
    lines += [f"  {rule} {reason}: {n}" for (rule, reason), n in sorted(unknown.items())]
    lines += ["", "no result of the peer:", *(f"  {name}: {said}" for name, said in sorted(without.items()))]
    return "\n".join(lines), share_unexplained <= 0.02 and share_decided >= 0.70


def compare(python: Path, folder: Path, scenarios: Sequence[Path] | None = None) -> tuple[str, bool]:
    """Compare on the scenarios, or on all public ones; return the text, and whether the bars are met."""
    return report(*compared(python, folder, list(scenarios or public_scenarios())))
