"""Types for the possible words of an SQL expression: a word of a vocabulary, a literal, a list or STRUCT of these, or a parameter.

None means that nothing is known about the expression, such as a number or a text from the log.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.sql.words import ColumnVocabulary, nearest_word_hint

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from drivelint.sql.words import WordColumn

_MOST_CONCATENATIONS = 200
"""`concatenation` gives up beyond this number of texts."""


class LiteralPlace(NamedTuple):
    """The position of a literal: its byte offset in the SQL (None: unknown), and whether it is within a macro.

    For a literal within a macro, the offset is that of the call.
    """

    offset: int | None
    in_macro: bool = False


@dataclass(frozen=True)
class PossibleWords:
    """A text: a word of any of these vocabularies, or one of these literals; NULL if both are empty.

    `direct`: the expression itself consists of literals only.
    """

    vocabularies: frozenset[ColumnVocabulary] = frozenset()
    literals: Mapping[str, LiteralPlace] = field(default_factory=dict)
    direct: bool = False

    def may_be(self, word: str) -> bool:
        """Return whether the text may be this word."""
        return word in self.literals or any(word in vocabulary for vocabulary in self.vocabularies)

    @property
    def is_null(self) -> bool:
        """Whether the text is always NULL."""
        return not self.vocabularies and not self.literals

    @property
    def possible_words(self) -> tuple[str, ...]:
        """All words that the text may be."""
        ordered = sorted(self.vocabularies)
        return tuple(dict.fromkeys([*(word for vocabulary in ordered for word in vocabulary.words), *self.literals]))


@dataclass(frozen=True)
class ListOf:
    """A list with items of these possible values."""

    item: WordType


@dataclass(frozen=True)
class StructOf:
    """A STRUCT with fields of these possible values."""

    fields: Mapping[str, WordType]


@dataclass(frozen=True)
class Parameter:
    """A parameter `$name` in the SQL."""

    name: str


WordType = PossibleWords | ListOf | StructOf | Parameter | None
NULL = PossibleWords(direct=True)


class WrongWord(NamedTuple):
    """A literal that is compared with an expression that can never have this value.

    `offset`: its byte offset in the SQL; None: unknown. `against`: the possible values of the expression.
    """

    word: str
    offset: int | None
    against: PossibleWords

    @property
    def message(self) -> str:
        """The error message, with the nearest valid word."""
        names = " or ".join(vocabulary.name.replace("_", " ") for vocabulary in sorted(self.against.vocabularies))
        contradiction = f"is no {names}" if names else "is never what it is compared with"
        return f"{self.word!r} {contradiction}; {nearest_word_hint(self.word.strip('%'), self.against.possible_words)}"


def possible_words_of_column(column: WordColumn) -> WordType:
    """Return the possible values of a table's column."""
    item: WordType = PossibleWords(frozenset({column.vocabulary}))
    item = StructOf({column.field: item}) if column.field else item
    return ListOf(item) if column.is_list else item


def as_indirect(kind: WordType) -> WordType:
    """Return the type without `direct`: for a value that is read by a column's name, or returned by a macro."""
    return replace(kind, direct=False) if isinstance(kind, PossibleWords) else kind


def union(kinds: Iterable[WordType]) -> WordType:
    """Return the union of possible values; NULL adds nothing."""
    parts = [kind for kind in kinds if not (isinstance(kind, PossibleWords) and kind.is_null)]
    if len(parts) < 2:
        return parts[0] if parts else NULL
    words = [part for part in parts if isinstance(part, PossibleWords)]
    lists = [part for part in parts if isinstance(part, ListOf)]
    structs = [part for part in parts if isinstance(part, StructOf)]
    if len(words) == len(parts):
        literals = {word: place for part in reversed(words) for word, place in part.literals.items()}
        vocabularies = frozenset[ColumnVocabulary]().union(*(part.vocabularies for part in words))
        return PossibleWords(vocabularies, literals, all(part.direct for part in words))
    if len(lists) == len(parts):
        return ListOf(union(part.item for part in lists))
    if len(structs) == len(parts):
        names = dict.fromkeys(name for part in structs for name in part.fields)
        return StructOf({name: union(part.fields.get(name) for part in structs) for name in names})
    return None


def concatenation(parts: Iterable[WordType]) -> WordType:
    """Return all concatenations of the possible values of `parts`; None if unknown or too many."""
    texts: list[list[tuple[str, LiteralPlace]]] = []
    for part in parts:
        if not isinstance(part, PossibleWords) or not all(vocabulary.has_all_words for vocabulary in part.vocabularies):
            return None
        texts.append([(word, part.literals.get(word, LiteralPlace(None))) for word in part.possible_words])
    combinations = list(product(*texts)) if len(texts) < 4 else []
    if not 0 < len(combinations) <= _MOST_CONCATENATIONS:
        return None
    return PossibleWords(
        literals={"".join(word for word, _ in combination): combination[0][1] for combination in combinations}
    )


def possible_words_of_field(kind: WordType, names: Iterable[str]) -> WordType:
    """Return the possible values of a field of a STRUCT. `names`: the field, then fields within it."""
    for name in names:
        kind = kind.fields.get(name) if isinstance(kind, StructOf) else None
    return kind


def possible_words_of_item(kind: WordType) -> WordType:
    """Return the possible values of an item of a list."""
    return kind.item if isinstance(kind, ListOf) else None


def possible_words_of_member(kind: WordType, key: WordType) -> WordType:
    """Return the possible values of `kind[key]`: an item of a list, or a field of a STRUCT."""
    return (
        possible_words_of_field(kind, map(str.lower, key.literals))
        if isinstance(key, PossibleWords)
        else possible_words_of_item(kind)
    )


def wrong_words(left: WordType, right: WordType) -> Iterator[WrongWord]:
    """Yield the literals on one side of a comparison that the other side can never be.

    A literal within a macro may only contradict a vocabulary, not other literals: the arguments of one call may have fewer values than
    the macro supports. Indirect literals, as from a CASE in a CTE, are wrong only if all of them are: some may mean "none of these".
    """
    for literals, other_side in ((left, right), (right, left)):
        if not (isinstance(literals, PossibleWords) and isinstance(other_side, PossibleWords)) or literals.vocabularies:
            continue
        if other_side.direct or not (literals.direct or other_side.vocabularies):
            continue
        wrong = [
            WrongWord(word, place.offset, other_side)
            for word, place in literals.literals.items()
            if (other_side.vocabularies or (other_side.literals and not place.in_macro)) and not other_side.may_be(word)
        ]
        if literals.direct or len(wrong) == len(literals.literals):
            yield from wrong


def _is_like(word: str, pattern: str) -> bool:
    parts = (".*" if letter == "%" else "." if letter == "_" else re.escape(letter) for letter in pattern)
    return re.fullmatch("".join(parts), word, re.DOTALL) is not None


_PATTERN_TEST_BY_FUNCTION: Final[Mapping[str, Callable[[str, str], bool]]] = {
    **dict.fromkeys(("~~", "!~~"), _is_like),
    **dict.fromkeys(("~~*", "!~~*"), lambda word, pattern: _is_like(word.casefold(), pattern.casefold())),
    **dict.fromkeys(("starts_with", "prefix", "^@"), str.startswith),
    **dict.fromkeys(("ends_with", "suffix"), str.endswith),
    "contains": str.__contains__,
}
"""Function of DuckDB -> its test of a word with a pattern."""


def wrong_patterns(function: str, text: WordType, pattern: WordType) -> Iterator[WrongWord]:
    """Yield the patterns of a LIKE, or of a function such as starts_with, that match no possible word of the text."""
    if function not in _PATTERN_TEST_BY_FUNCTION or not (
        isinstance(text, PossibleWords) and isinstance(pattern, PossibleWords) and pattern.direct
    ):
        return
    if text.direct or text.is_null or not all(vocabulary.has_all_words for vocabulary in text.vocabularies):
        return
    for text_pattern, place in pattern.literals.items():
        if not place.in_macro and not any(
            _PATTERN_TEST_BY_FUNCTION[function](word, text_pattern) for word in text.possible_words
        ):
            yield WrongWord(text_pattern, place.offset, text)
