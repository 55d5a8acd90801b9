"""`report.html`: one self-contained page that opens offline. Nothing is fetched, everything from a log is escaped.

Charts are our own SVG, made here: they print, work without the script, follow the page's colours in light and dark, and take
2 kB and half a millisecond each. Libraries were tried: Altair with vl-convert makes 13 kB and 64 ms a chart in fixed colours and
brings 100 MB; plotly's script alone is 4 MB; uPlot draws on a canvas, which neither prints sharply nor works without a script.
"""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

import duckdb
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from drivelint import __version__
from drivelint.report.html import page
from drivelint.report.html.anchors import anchor
from drivelint.result.schemas import OUTPUT_VERSION
from drivelint.result.text import measure, number

if TYPE_CHECKING:
    from drivelint.result.model import Result

_TEMPLATES: Final = Path(__file__).parent / "templates"


def render(result: Result) -> bytes:
    """Return the page as UTF-8; the same result gives the same bytes."""
    text = _environment().get_template("report.html.j2").render(page.content(result))
    return text.encode("utf-8", "replace")  # a file's name may not be text


@cache
def _environment() -> Environment:
    """Return the templates with the style and the script, which the page's policy names by their hashes."""
    environment = Environment(
        loader=FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    style, script = (
        "\n".join((_TEMPLATES / name).read_text(encoding="utf-8").strip() for name in names)
        for names in (("report.css", "charts.css", "narrow.css", "first.css"), ("tables.js", "report.js", "replay.js"))
    )
    environment.globals.update(
        style=Markup(style),  # noqa: S704 - ours
        script=Markup(script),  # noqa: S704 - ours
        policy=(
            f"default-src 'none'; style-src {_hash(style)}; script-src {_hash(script)}; img-src data:; "
            "base-uri 'none'; form-action 'none'"
        ),
        anchor=anchor,
        number=number,
        version=__version__,
        duckdb_version=duckdb.__version__,
        output_schema=OUTPUT_VERSION,
    )
    environment.filters["measure"] = measure
    return environment


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
