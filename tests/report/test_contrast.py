"""The words of a verdict have the contrast to their ground that WCAG 2 asks of text: 4.5 to 1."""

import re
from importlib import resources

import pytest

WORDS = ("fail", "pass", "unknown", "na", "error", "near", "dim", "ink", "link")


def _luminance(colour: str) -> float:
    digits = colour.removeprefix("#")
    digits = digits if len(digits) == 6 else "".join(digit * 2 for digit in digits)
    parts = [int(digits[at : at + 2], 16) / 255 for at in (0, 2, 4)]
    red, green, blue = (part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def _colours(scheme: int) -> dict[str, str]:
    """Return the colours of the light (0) or dark (1) scheme."""
    text = (resources.files("drivelint.report.html") / "templates" / "report.css").read_text("utf-8")
    return dict(re.findall(r"--(\w+): (#\w+);", re.findall(r":root \{(.*?)\}", text, re.DOTALL)[scheme]))


@pytest.mark.parametrize("scheme", [0, 1], ids=["light", "dark"])
@pytest.mark.parametrize("ground", ["page", "paper"])
@pytest.mark.parametrize("word", WORDS)
def test_a_verdict_is_legible(scheme: int, ground: str, word: str) -> None:
    colours = _colours(scheme)
    dark, light = sorted((_luminance(colours[word]), _luminance(colours[ground])))
    assert (light + 0.05) / (dark + 0.05) >= 4.5
