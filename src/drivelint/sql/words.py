"""The vocabularies of `schemas/words.toml`: which words the columns of the tables may hold, and the refusal of any other.

A column's comment in `schemas/*.sql` names its vocabulary in brackets, with further words: `[control + none]`; for a field of a STRUCT
`[fit: light_fit]`.
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

MARK: Final = re.compile(r"\[(?:(\w+): )?(\w+)((?: \+ \w+)*)\] ?")
"""The mark at the head of a column's comment: the field of a STRUCT, the vocabulary, and the words besides."""
_MOST_LISTED: Final = 14
"""A comment lists the words of a vocabulary of at most this many; of a longer one it gives the name."""
_NEAR: Final = 0.55
"""How alike a word that is proposed must be: `cyclist` and `bicycle` are 0.57."""
_MISSPELLED: Final = 0.85
"""So alike to a word of an open vocabulary is none of its own, but that word misspelled."""


Quantity = Literal["existence", "identity", "position", "heading", "velocity", "size", "class"]
"""The quantities of an actor that may be doubted."""


class Vocabulary(NamedTuple):
    """A vocabulary: its name, its words in order, a regular expression of what else is a word ('': nothing), and what they mean.

    `open`: any other word is one, too, if it is not nearly one of these.
    """

    name: str
    words: tuple[str, ...]
    pattern: str = ""
    says: str = ""
    open: bool = False

    def __contains__(self, word: object) -> bool:
        """Whether it has this word."""
        if word in self.words or (self.pattern and re.fullmatch(self.pattern, str(word))):
            return True
        return self.open and not get_close_matches(str(word), self.words, n=1, cutoff=_MISSPELLED)

    @property
    def is_listed(self) -> bool:
        """Whether its words are all that there are."""
        return not self.pattern and not self.open

    def spelled(self, word: str) -> str | None:
        """Return a word as it is spelled here, whatever its case; None: it has none such."""
        if word in self.words:
            return word
        return next((known for known in self.words if known.casefold() == word.casefold()), None)

    def problem(self, word: str) -> str | None:
        """Return the problem of a word, with the nearest good one; None: there is none."""
        return None if word in self else f"{word!r} is no {self.name.replace('_', ' ')}; {nearest(word, self.words)}"


class WordColumn(NamedTuple):
    """A column of words or of lists of words, or the `field` of the STRUCTs in it ('': the column itself)."""

    vocabulary: Vocabulary
    field: str = ""
    is_list: bool = False


def nearest(word: str, known_words: Iterable[str]) -> str:
    """Return "did you mean 'x'?" for the nearest known word, else "known are ..."."""
    return hint(word, known_words, cutoff=_NEAR)


@cache
def vocabularies() -> dict[str, Vocabulary]:
    """Return name -> vocabulary, in the order of the file."""
    facts = toml_facts(folder("schemas") / "words.toml")
    return {name: Vocabulary(name, **about | {"words": tuple(about["words"])}) for name, about in facts.items()}


def words(name: str) -> tuple[str, ...]:
    """Return the words of a vocabulary. Errors: `KeyError` for a name that is none."""
    return vocabularies()[name].words


def word_column(kind: str, comment: str) -> WordColumn | None:
    """Return the vocabulary in a column's comment; None: a column of this type has no words. Errors: `DriveLintError`."""
    mark = MARK.match(comment)
    if mark is None:
        return None
    field, name, more = mark.groups()
    if name not in vocabularies():
        raise DriveLintError(f"schemas: there is no vocabulary [{name}] in words.toml; {hint(name, vocabularies())}")
    known = vocabularies()[name]
    besides = tuple(more.split(" + ")[1:])
    return WordColumn(known._replace(words=known.words + besides), field or "", "[]" in kind)


def readable_comment(comment: str) -> str:
    """Return a column's comment with the words of its vocabulary in place of the mark."""
    column = word_column("", comment)
    if column is None:
        return comment
    known = column.vocabulary.words
    listed = ", ".join(known) if len(known) <= _MOST_LISTED else f"a word of {column.vocabulary.name}"
    if not column.vocabulary.is_listed:
        listed += ", ..."
    rest = MARK.sub("", comment, count=1)
    return "; ".join(part for part in (f"{column.field}: {listed}" if column.field else listed, rest) if part)


def refuse_wrong_words(table: pa.Table, columns: dict[str, WordColumn], where: str) -> None:
    """Refuse a table that a reader made, if it holds a word that is not in its vocabulary. NULL is no word; an open one has any.

    Errors: `InternalError` that begins with `where`, and names the column, the word and the nearest good one.
    """
    for name, column in columns.items():
        if column.vocabulary.open or column.field or name not in table.column_names:
            continue
        for word in _distinct(table[name]):
            if wrong := column.vocabulary.problem(word):
                raise InternalError(f"{where}, column {name}: {wrong}: a fault of the reader")


def _distinct(values: pa.ChunkedArray) -> list[str]:
    """Return the distinct texts in a column of texts or of lists of texts."""
    import pyarrow as pa
    import pyarrow.compute as pc

    flat = pc.list_flatten(values) if pa.types.is_list(values.type) else values
    return [word for word in pc.unique(flat).to_pylist() if word is not None]
