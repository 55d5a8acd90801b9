"""The catalogue as one Markdown page: a table per pack, for the Highway Code a table by clause, and the words of logs and maps.

`queries/README.md` is this page for the shipped packs; a test checks that it is up to date. A pack with a `clauses.toml` beside its
rules gets a table by clause: the rules and drafts that cover each clause, and the reasons why some clauses cannot be decided.
"""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from drivelint.drive.conditions import CONDITION_TEXTS, DRIVE_CONDITION_VALUES
from drivelint.drive.declared_events import EVENTS, ON_OFF_EVENTS
from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, SIGNAL_STATES
from drivelint.errors import RuleError
from drivelint.facts import toml_beside
from drivelint.phrases import escape_invisible
from drivelint.result.counts import group_rows
from drivelint.result.text_templates import cell, text_template
from drivelint.road.signcodes import signal_codes_by_list
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from drivelint.catalogue import Rule

_MAX_LISTED_RULES = 8  # if more rules match, only their number is printed
_COMMENT = re.compile(r"--.*")
_TAG = re.compile(r"<(?=[A-Za-z/!?])(?!br>)")
_CITED = re.compile(r"\b(?:R|H)\d+")
_NUMBER = re.compile(r"(H?)(\d+)(?:-(\d+))?")


class Clause(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An entry of `clauses.toml`: a clause or range of clauses, its subject, and why rules do not decide the whole clause."""

    of: str
    about: str
    why: str = ""

    @property
    def cited_names(self) -> set[str]:
        """The names by which rules cite the clauses, such as H1 or R103. Errors: `RuleError` if `of` is no clause or range."""
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
    """Return the clauses of the Highway Code in a rule's `clause` before the colon, such as R126 and H2."""
    head = rule.clause.split(":", 1)[0]
    return set(_CITED.findall(head)) if head.startswith("UKHC") else set()


def read_clauses(folder: Path) -> list[Clause]:
    """Read `clauses.toml` in a pack's folder; return [] if there is no such file. Errors: `RuleError` if the file is not valid."""
    file = folder / "clauses.toml"
    if not file.is_file():
        return []
    try:
        return msgspec.convert(parse_toml(file.read_text(encoding="utf-8")).get("clause", []), list[Clause])
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, msgspec.ValidationError, RecursionError) as error:
        raise RuleError(f"{file}: {error}") from error


def clause_coverage(rules: Iterable[Rule], table: Sequence[Clause]) -> list[ClauseCoverage]:
    """Return each clause with the rules that cover it.

    Errors: `RuleError` for a rule that cites a clause without an entry in the table, and for a clause that has neither rules nor a reason.
    """
    citing: dict[str, list[Rule]] = {}
    for rule in rules:
        for name in cited_clauses(rule):
            citing.setdefault(name, []).append(rule)
    known_names = {name for clause in table for name in clause.cited_names}
    strange = sorted(citing.keys() - known_names)
    if strange:
        raise RuleError(f"clauses.toml: {citing[strange[0]][0].id} cites {strange[0]}, which has no entry")
    rows = []
    for clause in table:
        citing_rules = {rule.id: rule for name in clause.cited_names for rule in citing.get(name, ())}
        covered = tuple(sorted(i for i, rule in citing_rules.items() if rule.status == "stable"))
        drafted = tuple(sorted(i for i, rule in citing_rules.items() if rule.status == "draft"))
        if not citing_rules and not clause.why:
            raise RuleError(f"clauses.toml: {clause.of}: no rule covers it, and it has no reason")
        rows.append(ClauseCoverage(clause, covered, drafted))
    return rows


def render_markdown(rules: Iterable[Rule], folder: Path) -> str:
    """Return the page for these rules; `folder` contains their packs, with their `clauses.toml` files."""
    rules = sorted(rules, key=lambda rule: rule.id)
    packs = group_rows(rules, lambda rule: rule.pack)
    clauses_by_pack = {pack: read_clauses(folder / pack) for pack in packs}
    return text_template(__file__, "catalogue.md.j2", finalize=_table_cell_without_markup).render(
        rules=rules,
        packs=packs,
        clauses={pack: clause_coverage(rules, table) if table else [] for pack, table in clauses_by_pack.items()},
        applies=_restrictions_text,
        asking=lambda requirements, reads: _text_on_rules_that_use(rules, requirements, reads),
        column_values={
            "actor_class": ACTOR_CLASSES,
            "indicator": INDICATORS,
            "brake_light": BRAKE_LIGHTS,
            "state of a signal": SIGNAL_STATES,
        },
        condition_values=DRIVE_CONDITION_VALUES,
        condition_texts=CONDITION_TEXTS,
        events=EVENTS,
        on_off_events=ON_OFF_EVENTS,
        map_features=map_features()["feature"],
        signs={kind: _signal_codes_text(kind, part) for kind, part in map_features()["name_parts"].items()},
    )


def _table_cell_without_markup(value: Any) -> Any:
    """Return a value for a table cell, without links, pictures and HTML (except line breaks), because rules may be untrusted."""
    if not isinstance(value, str):
        return value
    return cell(escape_invisible(_TAG.sub("&lt;", value).replace("](", "]\\(")))


def map_features() -> dict[str, Any]:
    """Return the content of `map_features.toml`: `name_parts` of signals, and each `feature`."""
    return toml_beside(__file__, "map_features.toml")


def _signal_codes_text(kind: str, name_part: str) -> str:
    """Return in Markdown how a signal of this kind is recognised."""
    codes = "; ".join(f"{country} {', '.join(numbers)}" for country, numbers in signal_codes_by_list(kind).items())
    return f"`signal` {codes}; or {name_part} in its name"


def _text_on_rules_that_use(rules: Iterable[Rule], requirements: Sequence[str], reads: Sequence[str]) -> str:
    """Return the ids of the rules that use one of `requirements`, or their number if there are many.

    A rule uses a requirement if it requires it, is restricted by it, or names it in its SQL. If `reads` is not empty, a name in the SQL
    counts only if the rule reads one of these tables.
    """
    pattern = re.compile("|".join(rf"(?<!\w){re.escape(word)}(?!\w)" for word in requirements))
    ids = [
        f"`{rule.id}`"
        for rule in rules
        if not {*rule.requires, *rule.applies.restricted_conditions}.isdisjoint(requirements)
        or (
            (not reads or not {*rule.reads}.isdisjoint(reads))
            and pattern.search(_COMMENT.sub("", "\n".join(rule.sections.values())))
        )
    ]
    return f"{len(ids)} rules" if len(ids) > _MAX_LISTED_RULES else ", ".join(ids) or "no rule"


def _restrictions_text(rule: Rule) -> str:
    conditions = {"law": rule.law, **msgspec.structs.asdict(rule.applies)}
    restrictions = [
        f"{name} {' or '.join(map(str, value)) if isinstance(value, tuple) else value}"
        for name, value in conditions.items()
        if value not in {None, ()}
    ]
    return ", ".join(restrictions)
