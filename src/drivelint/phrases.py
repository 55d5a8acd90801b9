"""Builds phrases that many messages share: the nearest known word, a list of names, a count with its noun."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

_INVISIBLE = re.compile(
    r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f"
    r"\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff]"
)
"""Characters that control a terminal, or reverse the reading order; a line's end is not one of them."""
_COMMAND: Final = re.compile(r"^(\s*):(?=:)|#(?=#\w*\[)", re.MULTILINE)
"""What a build server may take for a command when it stands in a job's output (`::error::`, `##[error]`, `##vso[task.x]`)."""
_IN_JSON: Final = re.compile(rf"{_INVISIBLE.pattern}|#(?=#\w*\[)")
_BREAK: Final = re.compile(r"\s*[\n\r\v\f\x1c-\x1e\x85\u2028\u2029]\s*")
_PLURAL: Final = {"bus": "buses", "actor of unknown class": "actors of unknown class"}


def escape_invisible(text: str) -> str:
    """Return text that may hold words of a log with the characters that nobody sees shown as their codes, such as `\\x1b`."""
    return _INVISIBLE.sub(lambda found: found[0].encode("unicode_escape", "surrogatepass").decode("ascii"), text)


def inert(text: str) -> str:
    """Return text that may hold words of a log for a terminal: characters that steer one are shown, and it gives no commands."""
    return _COMMAND.sub(lambda found: f"{found[0]}\\", escape_invisible(text))


def one_line(text: str) -> str:
    """Return text without ends of lines: a word of a log must not look like a line of ours."""
    return _BREAK.sub(" ", text.rstrip())


def inert_line(text: str) -> str:
    """Return such a text for a terminal as one line."""
    return inert(one_line(text))


def inert_json(text: str) -> str:
    """Return JSON that means the same and is inert on a terminal."""
    return _IN_JSON.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def hint(word: str, known_words: Iterable[str], *, cutoff: float = 0.6, sign: str = "") -> str:
    """Return "did you mean 'x'?" for the nearest known word, whatever its case, else "known are ...".

    `sign` stands before the word, in place of quotes.
    """
    words = list(dict.fromkeys(known_words))
    meant = nearest_word(word, words, cutoff=cutoff)
    if meant is None:
        return f"known are {', '.join(words)}"
    return f"did you mean {sign}{meant}?" if sign else f"did you mean {meant!r}?"


def nearest_word(word: str, known_words: Iterable[str], *, cutoff: float = 0.6) -> str | None:
    """Return the nearest known word, whatever its case; None: there is none near."""
    words = {each.casefold(): each for each in known_words}
    near = get_close_matches(word.casefold(), words, n=1, cutoff=cutoff)
    return words[near[0]] if near else None


def listed(names: Sequence[str], max_names: int = 5) -> str:
    """Return the first names and how many more there are."""
    more = len(names) - max_names
    return ", ".join(names[:max_names]) + (f" and {more} more" if more > 0 else "")


def plural(n: int, noun: str) -> str:
    """Return a count and its noun."""
    return f"{n} {noun if n == 1 else _PLURAL.get(noun, f'{noun}s')}"
