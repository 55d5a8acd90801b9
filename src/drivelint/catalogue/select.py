"""Choosing rules and setting their parameters, as the command line names them."""

from __future__ import annotations

from difflib import get_close_matches
from fnmatch import fnmatchcase
from math import isfinite
from typing import TYPE_CHECKING

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from drivelint.catalogue.load import Rule


def select(
    rules: Mapping[str, Rule], include: Sequence[str], ignore: Sequence[str], *, default_pack: str = "ukhc"
) -> list[Rule]:
    """Return the selected rules, sorted by id.

    A selector is an id, a glob over ids or a pack. None given: the stable rules of `default_pack`. A deprecated rule is
    chosen only
    by its full id. Errors: `UsageError` for a selector that matches nothing, or when nothing is left.
    """
    if include:
        chosen = {rule.id: rule for selector in include for rule in _matching(rules, selector)}
    else:
        chosen = {rule.id: rule for rule in rules.values() if rule.pack == default_pack and rule.status == "stable"}
    for selector in ignore:
        for rule in _matching(rules, selector):
            chosen.pop(rule.id, None)
    if not chosen:
        raise UsageError("no rule is left to check: see `drivelint rules list` and choose with --rules")
    return [chosen[rule_id] for rule_id in sorted(chosen)]


def _matching(rules: Mapping[str, Rule], selector: str) -> list[Rule]:
    if selector in rules:
        return [rules[selector]]
    found = [rule for rule in rules.values() if rule.pack == selector or fnmatchcase(rule.id, selector)]
    if not found:
        raise UsageError(
            f"no rule, pack or glob matches {selector!r}"
            + _nearest(selector, [*rules, *(rule.pack for rule in rules.values())])
        )
    return [rule for rule in found if rule.status != "deprecated"]


def _nearest(word: str, known: Iterable[str]) -> str:
    """Return '; did you mean ...?', or ''. A rule may also be meant by a part of its id."""
    names = {name: name for name in known}
    names |= {name.split(".", 1)[1]: name for name in list(names) if "." in name}
    holding = sorted((len(name), name) for name in names.values() if word in name)  # r162: the rule, not one alike
    near = [holding[0][1]] if holding else [names[n] for n in get_close_matches(word, names, n=1, cutoff=0.4)]
    return f"; did you mean {near[0]!r}?" if near else ""


def parse_params(
    rules: Mapping[str, Rule] | Iterable[Rule], settings: Sequence[str]
) -> dict[str, dict[str, float | str | bool]]:
    """Read `RULE.PARAM=VALUE` settings into rule id -> parameter -> value, typed like the parameter's default.

    Errors: `UsageError` for a setting without '=', an unknown rule or parameter (with the nearest one), or a value of
    another type.
    """
    known = {rule.id: rule for rule in (rules.values() if hasattr(rules, "values") else rules)}
    values: dict[str, dict[str, float | str | bool]] = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        rule_id, dot, param = name.strip().rpartition(".")
        if not equals or not dot:
            raise UsageError(f"--param {setting!r}: write RULE.PARAM=VALUE")
        if rule_id not in known:
            raise UsageError(f"--param {setting!r}: no rule {rule_id!r} is loaded{_nearest(rule_id, known)}")
        params = known[rule_id].params
        if param not in params:
            names = ", ".join(params) or "none"
            raise UsageError(f"--param {setting!r}: {rule_id} has no parameter {param!r}; it has: {names}")
        values.setdefault(rule_id, {})[param] = _typed(text.strip(), params[param].default, setting)
    return values


def _typed(text: str, default: float | bool | str, setting: str) -> float | bool | str:
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
