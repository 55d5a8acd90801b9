"""What a message says where a word is not known: the nearest word, else those that are known, as far as they can be read."""

from __future__ import annotations

import pytest

from drivelint.phrases import hint

NUMBERS = [f"word{n:02}" for n in range(100)]


@pytest.mark.parametrize(
    ("word", "known_words", "text"),
    [
        ("wrod07", NUMBERS, "did you mean 'word07'?"),
        ("x", ["a", "b", "a"], "known are a, b"),
        ("x", NUMBERS[:30], f"known are {', '.join(NUMBERS[:30])}"),
        ("x", NUMBERS[:31], f"known are {', '.join(NUMBERS[:30])} and 1 more"),
    ],
)
def test_a_hint_names_the_nearest_word_or_the_first_of_those_known(
    word: str, known_words: list[str], text: str
) -> None:
    assert hint(word, known_words) == text
