"""The vocabularies of `schemas/words.toml`: the words that columns of the tables may contain. Other words are refused.

A column's comment in `schemas/*.sql` names its vocabulary in brackets, with additional words: `[control + none]`. The mark for a field of
a STRUCT is `[fit: light_fit]`.
"""

from __future__ import annotations

import re
from difflib import get_close_matches
from functools import cache
from typing import TYPE_CHECKING, Final, Literal, NamedTuple

from drivelint.errors import DriveLintError, InternalError
from drivelint.facts import toml_facts
from drivelint.phrases import hint
from drivelint.resources import folder

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pyarrow as pa

VOCABULARY_MARK: Final = re.compile(r"\[(?:(\w+): )?(\w+)((?: \+ \w+)*)\] ?")
"""The mark at the start of a column's comment: the field of a STRUCT, the vocabulary, and additional words."""
_MOST_LISTED_WORDS: Final = 14
"""A readable comment lists at most this many words of a vocabulary; it only names a longer vocabulary."""
_LEAST_HINT_SIMILARITY: Final = 0.55
"""Least similarity of a word that is suggested (`difflib`): `cyclist` and `bicycle` have 0.57."""
_MISSPELLING_SIMILARITY: Final = 0.85
"""From this similarity on, a word is taken for a misspelled word of an open vocabulary, not for a new word."""


Quantity = Literal["existence", "identity", "position", "heading", "velocity", "size", "class"]
"""The quantities of an actor that may be uncertain."""


class ColumnVocabulary(NamedTuple):
    """A vocabulary: its name, its words in order, a regular expression for further words ('': none), and their meaning.

    `open`: any other word is valid, too, except a misspelled word of the vocabulary.
    """

    name: str
    words: tuple[str, ...]
    pattern: str = ""
    says: str = ""
    open: bool = False

    def __contains__(self, word: object) -> bool:
        """Return whether the word is valid."""
        if word in self.words or (self.pattern and re.fullmatch(self.pattern, str(word))):
            return True
        return self.open and not get_close_matches(str(word), self.words, n=1, cutoff=_MISSPELLING_SIMILARITY)

    @property
    def has_all_words(self) -> bool:
        """Whether `words` has all valid words."""
        return not self.pattern and not self.open

    def known_spelling(self, word: str) -> str | None:
        """Return a word as the vocabulary spells it, ignoring case; None if the vocabulary lacks it."""
        if word in self.words:
            return word
        return next((spelling for spelling in self.words if spelling.casefold() == word.casefold()), None)

    def problem(self, word: str) -> str | None:
        """Return an error message for an invalid word, with the nearest valid word; None for a valid word."""
        return (
            None
            if word in self
            else f"{word!r} is no {self.name.replace('_', ' ')}; {nearest_word_hint(word, self.words)}"
        )


class WordColumn(NamedTuple):
    """A column with words of a vocabulary. `field`: the field of its STRUCTs with the words, '' for the column itself.

    `is_list`: it has lists of words or STRUCTs.
    """

    vocabulary: ColumnVocabulary
    field: str = ""
    is_list: bool = False


def nearest_word_hint(word: str, known_words: Iterable[str]) -> str:
    """Return "did you mean 'x'?" for the nearest known word, else "known are ..."."""
    return hint(word, known_words, cutoff=_LEAST_HINT_SIMILARITY)


@cache
def vocabularies() -> dict[str, ColumnVocabulary]:
    """Return name -> vocabulary, in the order of the file."""
    facts = toml_facts(folder("schemas") / "words.toml")
    return {name: ColumnVocabulary(name, **about | {"words": tuple(about["words"])}) for name, about in facts.items()}


def words_of_vocabulary(name: str) -> tuple[str, ...]:
    """Return the words of a vocabulary. Errors: `KeyError` for a name without a vocabulary."""
    return vocabularies()[name].words


def word_column(kind: str, comment: str) -> WordColumn | None:
    """Return the vocabulary that a column's comment names; None if it names none. `kind`: the column's SQL type.

    Errors: `DriveLintError` for an unknown vocabulary.
    """
    mark = VOCABULARY_MARK.match(comment)
    if mark is None:
        return None
    field, name, more = mark.groups()
    if name not in vocabularies():
        raise DriveLintError(f"schemas: there is no vocabulary [{name}] in words.toml; {hint(name, vocabularies())}")
    vocabulary = vocabularies()[name]
    besides = tuple(more.split(" + ")[1:])
    return WordColumn(vocabulary._replace(words=vocabulary.words + besides), field or "", "[]" in kind)


def readable_comment(comment: str) -> str:
    """Return a column's comment with the vocabulary's words in place of the mark."""
    column = word_column("", comment)
    if column is None:
        return comment
    words = column.vocabulary.words
    listed = ", ".join(words) if len(words) <= _MOST_LISTED_WORDS else f"a word of {column.vocabulary.name}"
    if not column.vocabulary.has_all_words:
        listed += ", ..."
    rest = VOCABULARY_MARK.sub("", comment, count=1)
    return "; ".join(part for part in (f"{column.field}: {listed}" if column.field else listed, rest) if part)


def refuse_wrong_words(table: pa.Table, columns: dict[str, WordColumn], where: str) -> None:
    """Raise `InternalError` if a table of a reader contains a word outside its column's vocabulary.

    NULL and words of open vocabularies are valid. The message begins with `where`, and names the column, the word and the nearest valid
    word.
    """
    for name, column in columns.items():
        if column.vocabulary.open or column.field or name not in table.column_names:
            continue
        for word in _distinct_words(table[name]):
            if wrong := column.vocabulary.problem(word):
                raise InternalError(f"{where}, column {name}: {wrong}: a fault of the reader")


def _distinct_words(values: pa.ChunkedArray) -> list[str]:
    """Return the distinct texts in a column of texts or of lists of texts."""
    import pyarrow as pa
    import pyarrow.compute as pc

    flat = pc.list_flatten(values) if pa.types.is_list(values.type) else values
    return [word for word in pc.unique(flat).to_pylist() if word is not None]
