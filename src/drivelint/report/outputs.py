"""The files of a finished run, written together into one folder, and the formats of `drivelint report`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from drivelint.report import html, junit, markdown, sarif, summary, xqar
from drivelint.result import gate, request
from drivelint.result.files import parquet_bytes, publish
from drivelint.result.schemas import TABLE_OF_FILE

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from drivelint.result.model import Result

REPORT_FORMATS: Final[Mapping[str, tuple[str, Callable[[Result], bytes]]]] = {
    "html": ("report.html", html.render),
    "junit": ("junit.xml", junit.render),
    "sarif": ("report.sarif", sarif.render),
    "xqar": ("report.xqar", xqar.render),
    "markdown": ("report.md", markdown.render),
}
"""Name -> file in the result folder, and what renders it: the same result, the same bytes."""


def write(result: Result, out: Path) -> None:
    """Write every result file of `check` into the folder `out`; `summary.json` appears last, when the others are there.

    Same tables, same bytes. Errors: `OutputError` when the folder cannot be written.
    """
    contents = {f"{name}.parquet": parquet_bytes(getattr(result, name), table) for name, table in TABLE_OF_FILE.items()}
    contents["report.html"] = html.render(replace(result, folder=out))
    contents["junit.xml"] = junit.render(result)
    moved: dict[str, Path | None] = {"margins.parquet": result.margins_file}
    moved |= {name: None for name, _ in REPORT_FORMATS.values() if name not in contents}  # of an earlier result
    moved |= {gate.FILE: None, request.RUN_FILE: None}
    if result.gate is not None:
        contents[gate.FILE] = gate.render(result.gate)
    if result.asked is not None:
        contents[request.RUN_FILE] = request.render(result.asked, out)
    contents["summary.json"] = summary.render(result)
    publish(out, contents, moved)
