"""The explanation of one verdict as a Python object."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

from drivelint.api.notebook import preformatted_html
from drivelint.explain import text

if TYPE_CHECKING:
    from drivelint.explain import Explanation

_TEXT_LINE_CHARACTERS: Final = 120


class Explained:
    """The explanation that `drivelint explain` prints, as text or as data."""

    def __init__(self, explanation: Explanation) -> None:
        self._explanation = explanation

    @property
    def text(self) -> str:
        """The text that `drivelint explain` prints."""
        from rich.console import Console

        console = Console(width=_TEXT_LINE_CHARACTERS, highlight=False, color_system=None, force_jupyter=False)
        with console.capture() as captured:
            console.print(text.render(self._explanation, _TEXT_LINE_CHARACTERS))
        return "\n".join(line.rstrip() for line in captured.get().splitlines())

    def data(self) -> dict[str, Any]:
        """Return the output of `drivelint explain --format json` as plain data, with all digits of the numbers."""
        document: dict[str, Any] = json.loads(text.to_json(self._explanation))
        return document

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return preformatted_html(self.text)
