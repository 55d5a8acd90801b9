"""Builds phrases that many messages share: the nearest known word, a list of names, a count with its noun."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

_INVISIBLE = re.compile(
    r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f"
    r"\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff]"
)
"""Characters that control a terminal or reverse the reading order; not the line feed."""
_BUILD_SERVER_COMMAND_PATTERN: Final = re.compile(r"^(\s*):(?=:)|#(?=#\w*\[)", re.MULTILINE)
"""Texts in a job's output that a build server may run as a command (`::error::`, `##[error]`, `##vso[task.x]`)."""
_TERMINAL_UNSAFE_PATTERN_IN_JSON: Final = re.compile(rf"{_INVISIBLE.pattern}|#(?=#\w*\[)")
_LINE_BREAK: Final = re.compile(r"\s*[\n\r\v\f\x1c-\x1e\x85\u2028\u2029]\s*")
_IRREGULAR_PLURALS: Final = {"bus": "buses", "actor of unknown class": "actors of unknown class"}

_EGO_ID: Final = re.compile(r"ego(?![^\W_])|ego\d", re.IGNORECASE)
"""The beginning of an id that is the word "ego", alone or before a number or a separator."""


def escape_invisible(text: str) -> str:
    """Return a text, which may come from a log, with its invisible characters replaced by their codes, such as `\\x1b`."""
    return _INVISIBLE.sub(lambda match: match[0].encode("unicode_escape", "surrogatepass").decode("ascii"), text)


def terminal_safe(text: str) -> str:
    """Return a text, which may come from a log, made safe for a terminal: control characters as codes, no build-server commands."""
    return _BUILD_SERVER_COMMAND_PATTERN.sub(lambda match: f"{match[0]}\\", escape_invisible(text))


def one_line(text: str) -> str:
    """Return the text as one line: text from a log must not look like a line of drivelint."""
    return _LINE_BREAK.sub(" ", text.rstrip())


def terminal_safe_line(text: str) -> str:
    """Return a text as one line that is safe for a terminal (see `terminal_safe`)."""
    return terminal_safe(one_line(text))


def terminal_safe_json(text: str) -> str:
    """Return JSON with the same meaning that is safe for a terminal (see `terminal_safe`)."""
    return _TERMINAL_UNSAFE_PATTERN_IN_JSON.sub(lambda match: f"\\u{ord(match[0]):04x}", text)


_MOST_HINTED_WORDS: Final = 30
"""The most words that a hint lists: more are no help."""


def hint(word: str, known_words: Iterable[str], *, cutoff: float = 0.6, prefix: str = "") -> str:
    """Return "did you mean 'x'?" for the most similar known word, ignoring case; if none is similar, "known are ..." with the first.

    `prefix` is put before the word, in place of quotes.
    """
    words = list(dict.fromkeys(known_words))
    nearest = nearest_word(word, words, cutoff=cutoff)
    if nearest is None:
        return f"known are {name_list(words, _MOST_HINTED_WORDS)}"
    return f"did you mean {prefix}{nearest}?" if prefix else f"did you mean {nearest!r}?"


def nearest_word(word: str, known_words: Iterable[str], *, cutoff: float = 0.6) -> str | None:
    """Return the most similar known word, ignoring case; None: none is similar."""
    words = {known_word.casefold(): known_word for known_word in known_words}
    near = get_close_matches(word.casefold(), words, n=1, cutoff=cutoff)
    return words[near[0]] if near else None


def path_hint(path: Path) -> str:
    """Return "did you mean 'x'?" for a missing path, if a file or folder beside its first missing part has a similar name; else ''."""
    try:
        missing_part = next((part for part in (*reversed(path.parents), path) if not part.exists()), path)
        beside = sorted(entry.name for entry in missing_part.parent.iterdir())
    except (OSError, ValueError):  # a name may be too long, or the folder unreadable
        return ""
    near = nearest_word(missing_part.name, beside)
    if near is None:
        return ""
    candidate = missing_part.with_name(near)
    below = candidate / path.relative_to(missing_part)
    return f"did you mean {escape_invisible(str(below if below.exists() else candidate))!r}?"


def name_list(names: Sequence[str], max_names: int = 5) -> str:
    """Return the first names as a text, and how many more there are."""
    more = len(names) - max_names
    return ", ".join(names[:max_names]) + (f" and {more} more" if more > 0 else "")


def plural(n: int, noun: str) -> str:
    """Return a count with its noun, such as "2 logs"."""
    return f"{n} {noun if n == 1 else _IRREGULAR_PLURALS.get(noun, f'{noun}s')}"


def ego_name(ego_id: str) -> str:
    """Return an ego's name, such as "ego 7"; the id alone if it says "ego" itself, such as "Ego" or "ego_vehicle"."""
    return ego_id if _EGO_ID.match(ego_id) else f"ego {ego_id}"
