"""The conditions that may restrict a rule, the words (values) of each, and which words include others.

The words are vocabularies of `schemas/words.toml`. The `[applies]` table of a rule, `--env` and the conditions in a log use them. Each
condition is a column of `ego_condition`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from drivelint.errors import UsageError
from drivelint.facts import toml_beside
from drivelint.phrases import hint
from drivelint.sql.words import vocabularies, words_of_vocabulary

if TYPE_CHECKING:
    from collections.abc import Iterable

DRIVE_CONDITION_VALUES: Final = {name: words_of_vocabulary(name) for name in words_of_vocabulary("condition")}
"""Condition of a drive -> its words; includes `engaged`: whether the automated driver drives."""
RULE_CONDITION_VALUES: Final = {name: words for name, words in DRIVE_CONDITION_VALUES.items() if name != "engaged"}
"""Condition that may restrict a rule -> its words; for `nation`, `value_problem` also accepts other country codes."""
CONDITION_TEXTS: Final = {name: vocabularies()[name].says for name in DRIVE_CONDITION_VALUES}
"""Condition -> a text on what its words mean."""
_NARROWER_VALUES: Final[dict[str, list[str]]] = toml_beside(__file__, "conditions.toml")["narrower"]
_COUNTRY_CODE = re.compile(r"[a-z]{2}")
_NAME_BY_CASEFOLD = {name.casefold(): name for name in DRIVE_CONDITION_VALUES}


def value_problem(condition: str, word: str) -> str | None:
    """Return why this word is invalid for this condition, with the nearest valid word; None: it is valid."""
    if condition == "nation" and word.lower() == "uk":
        return "'uk' is no country code: use 'gb', or gb-eng, gb-wls, gb-sct"
    return vocabularies()[condition].problem(word)


def canonical_spelling(condition: str, word: str) -> tuple[str, str]:
    """Return a condition and its word in drivelint's spelling, whatever their case; unknown words stay as they are."""
    condition = _NAME_BY_CASEFOLD.get(condition.casefold(), condition)
    spelled = {spelling.casefold(): spelling for spelling in DRIVE_CONDITION_VALUES.get(condition, ())}
    country = condition == "nation" and _COUNTRY_CODE.fullmatch(word.casefold())
    return condition, spelled.get(word.casefold(), word.casefold() if country else word)


def with_narrower_values(values: tuple[str, ...]) -> list[str]:
    """Return these words and the words that they include: `gb` includes `gb-sct`, `town` includes `townLocal`."""
    return sorted({part for word in values for part in (word, *_NARROWER_VALUES.get(word, ()))})


def broader_values(values: tuple[str, ...]) -> list[str]:
    """Return the more general words, which leave open whether one of these words applies: `gb` for `gb-sct`."""
    inside = with_narrower_values(values)
    return sorted(wide for wide, parts in _NARROWER_VALUES.items() if wide not in inside and set(parts) & set(inside))


def related_values(values: tuple[str, ...]) -> set[str]:
    """Return these words, the words that they include, and the more general words (see `broader_values`)."""
    return {*with_narrower_values(values), *broader_values(values)}


def parse_env_settings(settings: Iterable[str]) -> tuple[tuple[str, str], ...]:
    """Return the `KEY=VALUE` settings of `--env`, in upper or lower case, as (condition, word), sorted by condition.

    Errors: `UsageError` for a setting without '=', an unknown key or word (with the nearest valid one), or two words for one key.
    """
    words: dict[str, str] = {}
    for setting in settings:
        key, equals, word = (part.strip() for part in setting.partition("="))
        if not equals:
            raise UsageError(f"--env {setting!r}: write KEY=VALUE, such as weather=wet")
        key, word = canonical_spelling(key, word)
        if wrong := condition_problem(key) or value_problem(key, word):
            raise UsageError(f"--env {setting!r}: {wrong}")
        if words.setdefault(key, word) != word:
            raise UsageError(f"--env {setting!r}: {key} is {words[key]!r} already: a drive has one {key}")
    return tuple(sorted(words.items()))


def condition_problem(condition: str) -> str | None:
    """Return why this is not the name of a condition, with the nearest valid name; None: it is valid."""
    if condition in DRIVE_CONDITION_VALUES:
        return None
    return f"{condition!r} is no condition of a drive; {hint(condition, DRIVE_CONDITION_VALUES)}"
