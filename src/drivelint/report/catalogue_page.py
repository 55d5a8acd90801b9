"""The catalogue as one Markdown page: a table per pack, for the Highway Code a table by clause, and the words of logs and maps.

`queries/README.md` is this page for the shipped packs; a test holds it to be current. A pack that has a `clauses.toml`
beside its rules gets the table by clause: what covers each clause, what is a draft, and what cannot be decided and why.
"""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from drivelint.errors import RuleError
from drivelint.report import vocabulary
from drivelint.result.counts import grouped

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from drivelint.catalogue import Rule

_CITED = re.compile(r"\b(?:R|H)\d+")
_NUMBER = re.compile(r"(H?)(\d+)(?:-(\d+))?")

INTRODUCTION = """# The rule catalogue

Written by `drivelint rules page`; edit the rules, not this page. A rule is a `.sql` file in `assertions/<pack>/` with its
cases beside it; `drivelint rules show ID` prints one with its SQL. Only *stable* rules gate; a *draft* is checked when it
is asked for. *law* names the nation whose law a rule is: in a drive of another nation it is not applicable. Packs are never
merged into one verdict: they ask different things of the same gap. At the end: [what a log can say](#what-a-log-can-say) and
[what a map must have](#what-a-map-must-have).
"""
LOG_INTRODUCTION = """## What a log can say

The words of its tables and of `--env CONDITION=VALUE`, in capital or small letters. What is not said is not known.
"""
CONDITIONS_INTRODUCTION = """What holds in the whole drive: `drive_condition.parquet` (`condition`, `value`), or `--env`, which counts more.
"""
EVENTS_INTRODUCTION = """What the ego declares: `declared_event.parquet` (`actor_id`, `t_ns`, `event`, `value`). An event that is on or
off holds until it is declared again, and is not known before the first time. Where a log never declares a look or a decision,
rules that ask for one are unknown.
"""
MAP_INTRODUCTION = """## What a map must have

In OpenDRIVE's terms. A `signal` is recognised by its `country` and `type` (no country: OpenDRIVE's and the German numbers), else by its
name, in capital or small letters. What a map does not say is not known.
"""


class Clause(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An entry of `clauses.toml`: a clause or range of clauses, its subject, and why rules do not decide all of it."""

    of: str
    about: str
    why: str = ""

    @property
    def names(self) -> set[str]:
        """The clauses as rules cite them: H1, R103, R89 to R94. Errors: `RuleError` for an `of` that is not one."""
        match = _NUMBER.fullmatch(self.of)
        if match is None:
            raise RuleError(f"clauses.toml: of = {self.of!r}: write H1, 103 or 89-94")
        first, last = int(match[2]), int(match[3] or match[2])
        return {f"{match[1] or 'R'}{n}" for n in range(first, last + 1)}


class ClauseCoverage(NamedTuple):
    """A clause, the stable rules that cover it and the draft rules that cite it."""

    clause: Clause
    covered: tuple[str, ...]
    drafted: tuple[str, ...]


def cited_clauses(rule: Rule) -> set[str]:
    """Return the Highway Code's clauses that a rule names at the head of its `clause` (up to the colon): R126, H2."""
    head = rule.clause.split(":", 1)[0]
    return set(_CITED.findall(head)) if head.startswith("UKHC") else set()


def read_clauses(folder: Path) -> list[Clause]:
    """Read `clauses.toml` of a pack's folder; none: []. Errors: `RuleError` where it is not understood."""
    file = folder / "clauses.toml"
    if not file.is_file():
        return []
    try:
        return msgspec.convert(tomllib.loads(file.read_text(encoding="utf-8")).get("clause", []), list[Clause])
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise RuleError(f"{file}: {error}") from error


def clause_coverage(rules: Iterable[Rule], table: Sequence[Clause]) -> list[ClauseCoverage]:
    """Return each clause with the rules that cover it.

    Errors: `RuleError` for a rule that cites a clause of which the table knows nothing, and for a clause without rules
    that does not say why.
    """
    citing: dict[str, list[Rule]] = {}
    for rule in rules:
        for name in cited_clauses(rule):
            citing.setdefault(name, []).append(rule)
    known = {name for clause in table for name in clause.names}
    strange = sorted(citing.keys() - known)
    if strange:
        raise RuleError(f"clauses.toml: {citing[strange[0]][0].id} cites {strange[0]}, which has no entry")
    rows = []
    for clause in table:
        mine = {rule.id: rule for name in clause.names for rule in citing.get(name, ())}
        covered = tuple(sorted(i for i, rule in mine.items() if rule.status == "stable"))
        drafted = tuple(sorted(i for i, rule in mine.items() if rule.status == "draft"))
        if not mine and not clause.why:
            raise RuleError(f"clauses.toml: {clause.of}: no rule covers it, and it does not say why")
        rows.append(ClauseCoverage(clause, covered, drafted))
    return rows


def page(rules: Iterable[Rule], folder: Path) -> str:
    """Return the page for rules whose packs lie in `folder` (for its clauses.toml files)."""
    rules = sorted(rules, key=lambda rule: rule.id)
    packs = grouped(rules, lambda rule: rule.pack)
    parts = [INTRODUCTION, _overview(packs)]
    for pack, mine in packs.items():
        parts.append(_pack(pack, mine))
        if known := read_clauses(folder / pack):
            parts.append(_clauses(clause_coverage(rules, known)))
    parts += [LOG_INTRODUCTION, "\n".join(vocabulary.column_value_lines()) + "\n"]
    parts += [CONDITIONS_INTRODUCTION, table(*vocabulary.condition_table(rules))]
    parts += [EVENTS_INTRODUCTION, table(*vocabulary.event_table(rules))]
    parts += [MAP_INTRODUCTION, table(*vocabulary.map_feature_table(rules))]
    return "\n".join(parts)


def _overview(packs: dict[str, list[Rule]]) -> str:
    total = [rule for mine in packs.values() for rule in mine]
    counted = [*((f"[`{pack}`](#{pack})", mine) for pack, mine in packs.items()), ("all", total)]
    rows = [
        (name, str(len(mine)), *(str(sum(rule.status == s for rule in mine)) for s in ("stable", "draft")))
        for name, mine in counted
    ]
    return table(("pack", "rules", "stable", "draft"), rows)


def _pack(pack: str, rules: Sequence[Rule]) -> str:
    rows = [
        (
            f"`{rule.id.removeprefix(pack + '.')}`",
            rule.hypothesis,
            f"{_kind(rule)}; {rule.severity}, {rule.legal}" + ("" if rule.status == "stable" else f"; *{rule.status}*"),
            ", ".join(f"`{signal}`" for signal in rule.requires) or "positions",
            _numbers(rule),
            rule.clause,
        )
        for rule in rules
    ]
    return f"## {pack}\n\n" + table(("rule", "asserts", "kind", "needs", "numbers", "from"), rows)


def _kind(rule: Rule) -> str:
    length = f"{rule.params[rule.window_s].default:g}" if isinstance(rule.window_s, str) else rule.window_s
    window = "" if length is None else f" {rule.quantifier} within {length} s"
    applies = _applies(rule)
    return rule.kind + window + (f", [{applies}]" if applies else "")


def _applies(rule: Rule) -> str:
    conditions = {"law": rule.law, **msgspec.structs.asdict(rule.applies)}
    said = [
        f"{name} {' or '.join(map(str, value)) if isinstance(value, tuple) else value}"
        for name, value in conditions.items()
        if value not in {None, ()}
    ]
    return ", ".join(said)


def _numbers(rule: Rule) -> str:
    def one(name: str, default: float | bool | str, unit: str) -> str:
        shown = f"{default:g}" if isinstance(default, float | int) and not isinstance(default, bool) else str(default)
        return f"`{name}` {shown} {unit}".rstrip()

    said = [
        f"{one(name, p.default, p.unit)}: {p.why}" + (f" ({p.source})" if p.source else "")
        for name, p in rule.params.items()
    ]
    return "<br>".join(said) or "none of its own"


def _clauses(rows: Sequence[ClauseCoverage]) -> str:
    def ids(names: Sequence[str]) -> str:
        return "<br>".join(f"`{name}`" for name in names)

    body = [(r.clause.of, r.clause.about, ids(r.covered), ids(r.drafted), r.clause.why) for r in rows]
    counts = (
        sum(bool(r.covered) for r in rows),
        sum(bool(r.drafted) and not r.covered for r in rows),
        sum(not r.covered and not r.drafted for r in rows),
    )
    return (
        "### By clause of the Highway Code\n\n"
        f"Of {len(rows)} entries {counts[0]} are covered, {counts[1]} drafted only, {counts[2]} undecidable from a trace. "
        "The last column says what is left open.\n\n"
        + table(("clause", "about", "covered by", "drafted", "not decided"), body)
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; cells are Markdown, on one line each."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"
