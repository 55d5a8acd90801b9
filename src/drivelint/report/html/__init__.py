"""`report.html`: one self-contained page that opens offline. It loads nothing from the network; all text from a log is escaped.

This folder draws the charts as SVG. They print, work without the script, and follow the page's light and dark colours.
A chart takes 2 kB and half a millisecond. Altair with vl-convert needs 13 kB and 64 ms per chart, has fixed colours, and
installs 100 MB. Plotly's script has 4 MB. uPlot draws on a canvas, which does not print sharply and needs a script.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from drivelint.report.html import page
from drivelint.report.html.environment import page_environment

if TYPE_CHECKING:
    from jinja2 import Environment

    from drivelint.result.model import Result


def render(result: Result, *, in_result_folder: bool = True) -> bytes:
    """Return the page, encoded in UTF-8; the same result gives the same bytes.

    `in_result_folder`: the page is for the folder of a result, so it shows the commands that read this folder, and
    links to its files.
    """
    content = page.content(result)
    if content["worst"] is not None and not in_result_folder:
        content["worst"].update(commands=[], files=[])
    text = _environment().get_template("report.html.j2").render(content)
    return text.encode("utf-8", "replace")  # the name of a file may contain bytes that are not UTF-8


@cache
def _environment() -> Environment:
    return page_environment(("tables.js", "report.js", "replay.js"))
