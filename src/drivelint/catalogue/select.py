"""Selects rules and sets their parameters from options of the command line.

A selector is a property of a rule, or several properties joined by commas, all of which the rule must have:

    ukhc.r162.safe-distance-ahead       a rule
    ukhc.r162.*                         a glob over ids
    ukhc                                a pack
    kind:invariant                      a word of the header: kind, subtype, severity, status, legal, derivation
    clause:R162                         a clause at the beginning of `clause` or in the id
    requires:indicator                  a signal that the rule requires
    all                                 every rule
    ukhc,severity:critical              both properties
"""

from __future__ import annotations

import re
from difflib import get_close_matches
from fnmatch import fnmatchcase
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING, Final

import msgspec

from drivelint.drive import conditions
from drivelint.errors import UsageError
from drivelint.globs import glob_length_problem
from drivelint.phrases import hint, name_list

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from drivelint.catalogue.rule import Rule


DEFAULT_PACK: Final = "ukhc"
"""The pack whose stable rules judge drives in all nations if `--rules` is not given."""


def select_rules(
    rules: Mapping[str, Rule],
    include: Sequence[str],
    ignore: Sequence[str],
    *,
    default_pack: str = DEFAULT_PACK,
    named_ids: Collection[str] | None = None,
) -> list[Rule]:
    """Return the selected rules, sorted by id.

    The module describes the selectors. An empty `include` selects the stable rules of `default_pack`. A deprecated rule is selected only
    by its full id or by `status:deprecated`. `is_named` of a rule is true if its id is in `named_ids`, or, for None, if a selector is or
    contains the id. Errors: `UsageError` if a selector matches no rule, or no rule is left.
    """
    if include:
        selection = {rule.id: rule for selector in include for rule in _matching_rules(rules, selector)}
    else:
        selection = {rule.id: rule for rule in rules.values() if rule.pack == default_pack and rule.status == "stable"}
    for selector in ignore:
        for rule in _matching_rules(rules, selector):
            selection.pop(rule.id, None)
    if not selection:
        raise UsageError("no rule is left to check: see `drivelint rules list` and choose with --rules")
    if named_ids is None:
        named_ids = {part.strip() for selector in include for part in selector.split(",")}
    return [msgspec.structs.replace(selection[name], is_named=name in named_ids) for name in sorted(selection)]


def default_packs(rules: Mapping[str, Rule], nation: str | None) -> tuple[str, ...]:
    """Return the packs that judge by default in a nation: `DEFAULT_PACK`, and the packs with stable rules of the nation's law."""
    of_its_law = {
        rule.pack
        for rule in rules.values()
        if rule.status == "stable" and rule.law and nation in conditions.related_values(rule.law)
    }
    return (DEFAULT_PACK, *sorted(of_its_law - {DEFAULT_PACK}))


def required_rules(
    rules: Mapping[str, Rule], selected: Iterable[Rule], required: Sequence[str], ignore: Sequence[str]
) -> tuple[str, ...]:
    """Return the sorted ids of the stable rules that may not be unknown: the selected rules that match the selectors `required`.

    Rules that match `ignore` are not required, unless a selector is their id. Errors: `UsageError` for a required id that is not
    selected, a selector without a selected rule, or a selector without a stable rule, since other rules do not gate.
    """
    selected_ids = {rule.id for rule in selected}
    left_out = {rule.id for selector in ignore for rule in _matching_rules(rules, selector)}
    ids: set[str] = set()
    for selector in required:
        stable = {rule.id for rule in _matching_rules(rules, selector) if rule.status == "stable"}
        if not stable:
            raise UsageError(f"--require {selector!r}: is not a stable rule, and other rules cannot fail a run")
        # a selector such as a severity matches rules of every pack: only the selected rules of the run are required
        lacking = sorted(stable - selected_ids - (left_out - {selector}))
        if not stable & selected_ids and not lacking:
            raise UsageError(f"--require {selector!r}: --ignore excludes all of its rules")
        if lacking and (selector in rules or not stable & selected_ids):
            raise UsageError(f"--require {selector!r}: not selected by --rules: {name_list(lacking, 3)}")
        ids |= stable & selected_ids
    return tuple(sorted(ids))


def _matching_rules(rules: Mapping[str, Rule], selector: str) -> list[Rule]:
    """Return the rules that match every comma-separated part of the selector."""
    parts = [part.strip() for part in selector.split(",")]
    ids_by_part = [{rule.id for rule in _rules_matching_part(rules, part)} for part in parts]
    ids = set.intersection(*ids_by_part)
    if not ids and len(parts) > 1:
        raise UsageError(
            f"no rule is all of {selector!r}: each part alone selects some; for any of them, repeat --rules"
        )
    return [rules[rule_id] for rule_id in sorted(ids)]


def _rules_matching_part(rules: Mapping[str, Rule], part: str) -> list[Rule]:
    """Return the rules that match one part of a selector. Errors: `UsageError` if no rule, pack or glob matches."""
    if part in rules:
        return [rules[part]]
    method, colon, word = part.partition(":")
    if colon:
        return [
            rule
            for rule in _rules_with_property(rules, method, word)
            if rule.status != "deprecated" or word == rule.status
        ]
    if problem := glob_length_problem(part):
        raise UsageError(f"the selector of rules {part[:40]!r}... has {problem}")
    matches = [rule for rule in rules.values() if part in {"all", rule.pack} or fnmatchcase(rule.id, part)]
    if not matches:
        names = [*rules, *(rule.pack for rule in rules.values())]
        raise UsageError(
            f"no rule, pack or glob matches {part!r}{_nearest_hint(part, names)} (rules of your own: --rules-dir DIR)"
        )
    return [rule for rule in matches if rule.status != "deprecated"]


def _rules_with_property(rules: Mapping[str, Rule], property_name: str, word: str) -> list[Rule]:
    """Return the rules with this word for a property (`property_name`). Errors: `UsageError` that lists valid properties or words."""
    if property_name not in _WORDS_OF_PROPERTY:
        raise UsageError(f"rules are not selected by {property_name!r}; {hint(property_name, _WORDS_OF_PROPERTY)}")
    words = {rule.id: _WORDS_OF_PROPERTY[property_name](rule) for rule in rules.values()}
    matches = [rules[rule_id] for rule_id, words_of_rule in words.items() if word.casefold() in words_of_rule]
    if not matches:
        names = sorted({name for words_of_rule in words.values() for name in words_of_rule})
        listed = f"; known are {', '.join(names)}" if len(names) <= _MAX_LISTED_WORDS else ""
        raise UsageError(f"no rule has the {property_name} {word!r}{_nearest_hint(word, names) or listed}")
    return matches


def clause_names(rule: Rule) -> set[str]:
    """Return the clause names, in lower case, by which a rule can be selected; from its `clause` and its id."""
    names = re.findall(r"[A-Za-z]*\d[\w.()]*", rule.clause.split(":", 1)[0])
    inside = rule.id.split(".")[1:2] if rule.id.count(".") > 1 else []
    return {name.rstrip(".").casefold() for name in [*names, *inside]}


def _words_of_header_field(name: str, rule: Rule) -> set[str]:
    return {getattr(rule, name)} - {None}


_WORDS_OF_PROPERTY: Final[dict[str, Callable[[Rule], set[str]]]] = {
    **{
        name: partial(_words_of_header_field, name)
        for name in ("kind", "subtype", "severity", "status", "legal", "derivation")
    },
    "clause": clause_names,
    "requires": lambda rule: set(rule.requires),
}
_MAX_LISTED_WORDS: Final = 12


def _nearest_hint(word: str, candidates: Iterable[str]) -> str:
    """Return '; did you mean ...?' or ''. A word that is part of a rule's id also suggests this rule."""
    names = {name: name for name in candidates}
    names |= {name.split(".", 1)[1]: name for name in list(names) if "." in name}
    holding = sorted((len(name), name) for name in names.values() if word in name)  # r162: a rule with it in the id
    near = [holding[0][1]] if holding else [names[n] for n in get_close_matches(word, names, n=1, cutoff=0.4)]
    return f"; did you mean {near[0]!r}?" if near else ""


def parse_params(rules: Iterable[Rule], settings: Sequence[str]) -> dict[str, dict[str, float | str | bool]]:
    """Parse settings `RULE.PARAM=VALUE` and return rule id -> parameter -> value, with the type of the parameter's default.

    Errors: `UsageError` for a setting without '=', an unknown rule (with the nearest id) or parameter (with the known ones), or a wrong
    value.
    """
    rule_by_id = {rule.id: rule for rule in rules}
    values: dict[str, dict[str, float | str | bool]] = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        rule_id, dot, param = name.strip().rpartition(".")
        if not equals or not dot:
            raise UsageError(f"--param {setting!r}: write RULE.PARAM=VALUE")
        if rule_id not in rule_by_id:
            raise UsageError(f"--param {setting!r}: no rule {rule_id!r} is loaded{_nearest_hint(rule_id, rule_by_id)}")
        params = rule_by_id[rule_id].params
        if param not in params:
            names = ", ".join(params) or "none"
            raise UsageError(f"--param {setting!r}: {rule_id} has no parameter {param!r}; it has: {names}")
        value = _parse_value(text.strip(), params[param].default, setting)
        from drivelint.catalogue.rule_words import parameter_problem  # imported here, since it imports the SQL parser

        if problem := parameter_problem(rule_by_id[rule_id].sections, param, value):
            raise UsageError(f"--param {setting!r}: {problem}")
        values.setdefault(rule_id, {})[param] = value
    return values


def _parse_value(text: str, default: float | bool | str, setting: str) -> float | bool | str:
    if isinstance(default, bool):
        words = {"true": True, "false": False}
        if text.lower() not in words:
            raise UsageError(f"--param {setting!r}: must be true or false")
        return words[text.lower()]
    if isinstance(default, str):
        return text
    try:
        value = float(text)
    except ValueError as error:
        raise UsageError(f"--param {setting!r}: {text!r} is not a number") from error
    if not isfinite(value):
        raise UsageError(f"--param {setting!r}: must be a finite number")
    return value
