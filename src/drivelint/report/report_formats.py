"""The formats in which `drivelint report` writes a result."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.report import html, junit, markdown, sarif, xqar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from drivelint.result.model import Result

REPORT_FORMATS: Final[Mapping[str, tuple[str, Callable[[Result], bytes]]]] = {
    "html": ("report.html", html.render),
    "junit": ("junit.xml", junit.render),
    "sarif": ("report.sarif", sarif.render),
    "xqar": ("report.xqar", xqar.render),
    "markdown": ("report.md", markdown.render),
}
"""Name -> file in the result folder, and what renders it: the same result, the same bytes."""
