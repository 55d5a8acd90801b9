"""The reason for one verdict, for Python."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

from drivelint.api.notebook import block_html
from drivelint.explain import text

if TYPE_CHECKING:
    from drivelint.explain import Explanation

_WIDTH: Final = 120


class Explained:
    """An explanation as `drivelint explain` gives it: as text, or as data."""

    def __init__(self, explanation: Explanation) -> None:
        self._explanation = explanation

    @property
    def text(self) -> str:
        """The output of the command line."""
        from rich.console import Console

        console = Console(width=_WIDTH, highlight=False, color_system=None, force_jupyter=False)
        with console.capture() as captured:
            console.print(text.render(self._explanation, _WIDTH))
        return "\n".join(line.rstrip() for line in captured.get().splitlines())

    def data(self) -> dict[str, Any]:
        """Return the output of `--format json` as plain data: the numbers in full."""
        told: dict[str, Any] = json.loads(text.to_json(self._explanation))
        return told

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return block_html(self.text)
