"""`report.html`: one self-contained page that opens offline. Nothing is fetched, everything from a log is escaped.

Charts are our own SVG, made here: they print, work without the script, follow the page's colours in light and dark, and take
2 kB and half a millisecond each. Libraries were tried: Altair with vl-convert makes 13 kB and 64 ms a chart in fixed colours and
brings 100 MB; plotly's script alone is 4 MB; uPlot draws on a canvas, which neither prints sharply nor works without a script.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from drivelint.report.html import page
from drivelint.report.html.environment import page_environment

if TYPE_CHECKING:
    from jinja2 import Environment

    from drivelint.result.model import Result


def render(result: Result) -> bytes:
    """Return the page as UTF-8; the same result gives the same bytes."""
    text = _environment().get_template("report.html.j2").render(page.content(result))
    return text.encode("utf-8", "replace")  # a file's name may not be text


@cache
def _environment() -> Environment:
    return page_environment(("tables.js", "report.js", "replay.js"))
