"""The catalogue as text for users (`rules list`, `rules show`) and as JSON for programs (`rules list --format json`)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Final

from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from drivelint.phrases import one_line
from drivelint.report import NARROW_BELOW_COLUMNS

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rich.console import RenderableType

    from drivelint.catalogue import Rule
    from drivelint.catalogue.header import Conditions

_DEFAULT_MERGE_GAP_S: Final = 1.0
"""The default of `merge_gap_s` in a rule's header."""


def rules_as_json(rules: Iterable[Rule]) -> str:
    """Return a JSON list with id, pack, kind, subtype, severity, status, clause and requirements of each rule."""
    keys = ("id", "pack", "kind", "subtype", "severity", "status", "clause")
    rows = [{key: getattr(rule, key) for key in keys} | {"requires": sorted(rule.requires)} for rule in rules]
    return json.dumps(rows, indent=2, ensure_ascii=False)


def rules_table(rules: Iterable[Rule], width: int = 120) -> Table:
    """Return a table of the rules for a terminal of `width` columns: id, kind, severity, status and title; if narrow, without kind."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    wide = width >= NARROW_BELOW_COLUMNS
    for name in ("rule", *(("kind",) if wide else ()), "severity", "status"):
        table.add_column(name, no_wrap=True)
    table.add_column("question", ratio=1)
    for rule in rules:
        kind = [f"{rule.kind}, {rule.subtype}" if rule.subtype else rule.kind] if wide else []
        table.add_row(rule.id, *kind, rule.severity, rule.status, Text(one_line(rule.title)))
    return table


def rule_details(rule: Rule) -> Group:
    """Return all facts about one rule: its title, its source, the settings of its header, its parameters and its reasons."""
    facts = Table(box=None, show_header=False, pad_edge=False)
    facts.add_column(style="bold", no_wrap=True)
    facts.add_column(overflow="fold")
    requires = ", ".join(sorted(rule.requires)) or "positions only"
    sense = "must be true" if rule.sense == "holds" else f"observed {rule.sense} required, in {rule.unit}"
    for name, value in (
        ("clause", f"{rule.clause} ({rule.legal}, {rule.derivation})"),
        ("law", ", ".join(rule.law)),
        ("question", rule.hypothesis),
        ("kind", f"{rule.kind}, {rule.subtype}" if rule.subtype else rule.kind),
        ("window", "" if rule.window_s is None else _duration_text(rule, "window_s")),
        ("quantifier", rule.quantifier if rule.subtype else ""),
        ("combine", "" if rule.combine == "each" else f"{rule.combine}: one verdict for all objects"),
        ("applies", _restrictions_text(rule.applies)),
        ("exempt after", _duration_text(rule, "exempt_after_s") if rule.exempt_after_s else ""),
        ("merge gap", "" if rule.merge_gap_s == _DEFAULT_MERGE_GAP_S else _duration_text(rule, "merge_gap_s")),
        ("observes", rule.observes or ""),
        ("sense", sense),
        ("near margin", "" if rule.near_margin is None else f"{rule.near_margin:g} {rule.unit}"),
        ("severity", f"{rule.severity}, {rule.status}"),
        ("tags", ", ".join(rule.tags)),
        ("requires", requires),
        ("pass requires", ", ".join(rule.pass_requires)),
        ("without time", rule.without_time or ""),
        ("without anchor", rule.without_anchor or ""),
        ("reads", ", ".join(rule.reads)),
        ("version", rule.version),
    ):
        if value:
            facts.add_row(name, Text(value))
    parts: list[RenderableType] = [Text(f"{rule.id}: {one_line(rule.title)}", style="bold"), facts]
    if rule.params:
        rows = [(name, str(param.default), param.unit, param.why, param.source) for name, param in rule.params.items()]
        parts.append(_table(("parameter", "default", "unit", "why", "source"), rows))
    if rule.reasons:
        words = [(code, reason.says, reason.advice) for code, reason in rule.reasons.items()]
        parts.append(_table(("reason", "says", "advice"), words))
    return Group(*parts)


def path_and_sql(rule: Rule) -> Text:
    """Return the path of the rule's file and its SQL, unformatted, so that both can be copied."""
    return Text("\n".join([str(rule.path), *(f"\n-- @{name}\n{sql}" for name, sql in rule.sections.items())]))


def _restrictions_text(conditions: Conditions) -> str:
    """Return the conditions under which a rule applies, such as `road_type rural or town, limit_min_mps 13.4`; '' for none."""
    texts = [f"{name} {' or '.join(words)}" for name, words in conditions.restricted_conditions.items()]
    limits = {"limit_min_mps": conditions.limit_min_mps, "limit_max_mps": conditions.limit_max_mps}
    return ", ".join([*texts, *(f"{name} {value:g}" for name, value in limits.items() if value is not None)])


def _duration_text(rule: Rule, key: str) -> str:
    """Return a duration from the rule's header, and the parameter that sets it, if there is one."""
    value = getattr(rule, key)
    return f"{rule.params[value].default:g} s ({value})" if isinstance(value, str) else f"{value:g} s"


def _table(names: Iterable[str], rows: Iterable[tuple[str, ...]]) -> Table:
    table = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False)
    for name in names:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*map(Text, row))
    return table
