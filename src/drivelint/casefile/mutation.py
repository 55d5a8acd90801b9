"""Judges each mutant of a rule by the rule's cases, and counts the mutants that at least one case notices.

A mutant that no case notices shows that a case is missing. A mutant that is no valid SQL is not counted: it proves nothing. If no case can
notice a mutant, because it is equivalent to the rule, the pack's `survivors.toml` lists it: `[[survivor]]` with `rule` (its id), `mutant`
(the fault as printed) and `reason`.
"""

from __future__ import annotations

import tomllib
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from typing import TYPE_CHECKING, Final, NamedTuple

import msgspec

from drivelint.casefile import case_location, first_unexpected_merged_case, numbered_cases, read_cases
from drivelint.casefile.binding_errors import is_valid_sql
from drivelint.casefile.merged_cases import MERGE_KEYS, judge, merge_cases, mergeable_groups
from drivelint.casefile.mutants import mutants, printed_rule
from drivelint.errors import RuleError, WorkerLostError
from drivelint.phrases import plural
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from drivelint.casefile.mutants import Mutant
    from drivelint.catalogue import Rule

_SURVIVOR_ADVICE: Final = (
    "     add a case that the changed SQL decides differently: for a number, with a value between the two numbers\n"
    "     if no case can, another part of the SQL decides already: leave this one out"
)
_PLACE_ADVICE: Final = "     #2 and so on: another place of the SQL with the same words"
SURVIVORS_FILE: Final = "survivors.toml"
LEAST_NOTICED_SHARE: Final = 0.95
"""The share of the mutants of stable rules that must be noticed, even if survivors are listed."""


class MutationResult(NamedTuple):
    """The result of judging a rule's mutants.

    `survivors`: the faults that no case noticed; `listed`: the faults in the pack's `survivors.toml`; `problem`: why the
    mutants could not be judged (the rule itself fails its cases), or ''.
    """

    rule_id: str
    stable: bool
    n: int
    survivors: tuple[str, ...]
    listed: tuple[str, ...]
    problem: str = ""

    @property
    def n_noticed(self) -> int:
        """The number of mutants that at least one case noticed; 0 if the mutants could not be judged."""
        return 0 if self.problem else self.n - len(self.survivors)

    @property
    def unlisted_survivors(self) -> tuple[str, ...]:
        """The survivors that are not listed."""
        return tuple(fault for fault in self.survivors if fault not in self.listed)

    @property
    def stale_listed_faults(self) -> tuple[str, ...]:
        """Listed faults that a case notices, or that are not among the rule's mutants."""
        return tuple(fault for fault in self.listed if fault not in self.survivors)

    @property
    def ok(self) -> bool:
        """Whether there is no problem, no stale entry, and, for a stable rule, no unlisted survivor."""
        return not (self.problem or self.stale_listed_faults or (self.stable and self.unlisted_survivors))


class _ListedSurvivor(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    rule: str
    """The id of the rule, or the name of the table."""
    mutant: str
    reason: str


class _ListedSurvivorsFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    survivor: list[_ListedSurvivor] = []


def judge_all_mutants(rules: Sequence[Rule], jobs: int) -> Iterator[MutationResult]:
    """Yield the result of each rule, in order, judged in `jobs` processes.

    Errors: `WorkerLostError` if one of the processes dies: a `multiprocessing.Pool` would wait for its result forever.
    """
    if jobs <= 1 or len(rules) < 4:
        yield from map(judge_mutants, rules)
        return
    # DuckDB does not work after a fork
    with ProcessPoolExecutor(min(jobs, len(rules)), get_context("spawn")) as pool:
        try:
            yield from pool.map(judge_mutants, rules)
        except BrokenProcessPool as error:
            raise WorkerLostError("a process that judged mutants has died: is there enough memory for two?") from error
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def noticed_share(results: Sequence[MutationResult]) -> float:
    """Return the share of the mutants of stable rules that at least one case noticed."""
    n = sum(result.n for result in results if result.stable)
    return sum(result.n_noticed for result in results if result.stable) / n if n else 1.0


def result_text(result: MutationResult) -> str:
    """Return the result as text: one line, and one more for each unlisted survivor and stale entry."""
    draft = "" if result.stable else " (not stable yet: it may have survivors)"
    noticed = f"{result.n_noticed} of {result.n} mutants noticed{draft}"
    return "\n".join(
        [
            f"{'ok  ' if result.ok else 'FAIL'} {result.rule_id}: {result.problem or noticed}",
            *(f"     no case notices: {fault}" for fault in result.unlisted_survivors),
            *([_PLACE_ADVICE] if any(" #" in fault for fault in result.unlisted_survivors) else []),
            *([_SURVIVOR_ADVICE] if result.unlisted_survivors else []),
            *(f"     listed in {SURVIVORS_FILE}, but noticed or gone: {fault}" for fault in result.stale_listed_faults),
        ]
    )


def summary_line(results: Sequence[MutationResult], tested: str = "stable rule") -> str:
    """Return the counts of all results in one line; `tested`: what has them."""
    if not results:
        return "nothing was tested"
    stable = [result for result in results if result.stable]
    if not stable:
        return "no stable rule here: only the mutants of stable rules must be noticed"
    n, noticed = sum(result.n for result in stable), sum(result.n_noticed for result in stable)
    return f"{plural(len(stable), tested)}: {noticed} of {n} mutants noticed ({noticed_share(results):.1%})"


def judge_mutants(rule: Rule) -> MutationResult:
    """Judge every mutant of a rule by the rule's cases; a mutant is noticed if the outcome of a case differs from `expect`.

    The cases are judged together, first as drives of one database, then, by the remaining mutants, as egos of one drive.
    """
    listed: tuple[str, ...] = ()
    survivors: tuple[str, ...] = ()
    problem = ""
    wrong = mutants(rule)
    n = len(wrong)
    try:
        listed = tuple(
            entry.mutant for entry in read_survivors(rule.path.parent / SURVIVORS_FILE) if entry.rule == rule.id
        )
        survivors, n_invalid = _survivors_and_number_of_invalid_mutants(rule, wrong)
        n -= n_invalid
    except RuleError as error:
        problem = str(error)
    return MutationResult(rule.id, rule.status == "stable", n, survivors, listed, problem)


def _survivors_and_number_of_invalid_mutants(rule: Rule, candidates: list[Mutant]) -> tuple[tuple[str, ...], int]:
    """Return the faults of the mutants that no case notices, and the number of mutants that are no valid SQL, which prove nothing."""
    cases = read_cases(rule)
    numbered = numbered_cases(rule, cases)
    printed_variant = printed_rule(rule)
    n_invalid = 0
    for key, where in MERGE_KEYS.items():
        for group in mergeable_groups(numbered, key):
            variants = [rule, printed_variant, *(mutant.rule for mutant in candidates)]
            outcomes = judge(variants, merge_cases(group, key), group[0].params)
            if wrong := first_unexpected_merged_case(cases, group, outcomes[rule.id]):
                place = case_location(rule, wrong[0])
                raise RuleError(f"{place}: {wrong[1]} (the rule itself, its cases judged as {where}: see rules test)")
            if first_unexpected_merged_case(cases, group, outcomes[printed_variant.id]):
                raise RuleError(f"{rule.path}: printed by DuckDB, the SQL has another meaning: no mutant can be judged")
            survivors = []
            for mutant in candidates:
                outcome = outcomes[mutant.rule.id]
                if not first_unexpected_merged_case(cases, group, outcome):
                    survivors.append(mutant)
                elif all(row["verdict"] == "error" for row in outcome.verdicts):
                    n_invalid += not is_valid_sql(mutant.rule)
            candidates = survivors
    return tuple(mutant.fault for mutant in candidates), n_invalid


def unknown_rule_messages(rules: Sequence[Rule]) -> list[str]:
    """Return a line per entry of the packs' `survivors.toml` with an unknown rule. Errors: `RuleError` for an invalid file."""
    known_ids = {rule.id for rule in rules}
    return [
        f"{pack / SURVIVORS_FILE}: there is no rule {name!r} here"
        for pack in dict.fromkeys(rule.path.parent for rule in rules)
        for name in sorted({entry.rule for entry in read_survivors(pack / SURVIVORS_FILE)} - known_ids)
    ]


def read_survivors(file: Path) -> list[_ListedSurvivor]:
    """Return the entries of a file of survivors; a missing file has none. Errors: `RuleError` for an invalid file."""
    if not file.is_file():
        return []
    try:
        return msgspec.convert(parse_toml(file.read_text(encoding="utf-8")), _ListedSurvivorsFile).survivor
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise RuleError(f"{file}: {error}") from error
