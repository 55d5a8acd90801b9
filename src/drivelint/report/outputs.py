"""The files of a finished run, written together into one folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.report import html, junit, summary
from drivelint.report.report_formats import REPORT_FORMATS
from drivelint.result import gate_file, request
from drivelint.result.files import parquet_bytes, publish
from drivelint.result.schemas import TABLE_OF_FILE

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.result.model import Result


def write(result: Result, out: Path) -> None:
    """Write every result file of `check` into the folder `out`; `summary.json` appears last, when the others are there.

    Same tables, same bytes. Errors: `OutputError` when the folder cannot be written.
    """
    contents = {f"{name}.parquet": parquet_bytes(getattr(result, name), table) for name, table in TABLE_OF_FILE.items()}
    contents["report.html"] = html.render(result)
    contents["junit.xml"] = junit.render(result)
    moved: dict[str, Path | None] = {"margins.parquet": result.margins_file}
    moved |= {name: None for name, _ in REPORT_FORMATS.values() if name not in contents}  # of an earlier result
    if result.gate is None:
        moved[gate_file.FILE] = None
    else:
        contents[gate_file.FILE] = gate_file.render(result.gate)
    if result.asked is None:
        moved[request.RUN_FILE] = None
    else:
        contents[request.RUN_FILE] = request.render(result.asked, out)
    contents["summary.json"] = summary.render(result)
    publish(out, contents, moved)
