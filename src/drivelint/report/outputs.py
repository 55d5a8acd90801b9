"""The files of a finished run, written together into one folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.report import html, junit, summary
from drivelint.report.contract import FILES
from drivelint.report.files import parquet_bytes, publish

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.report.result import Result


def write(result: Result, out: Path) -> None:
    """Write every result file of `check` into the folder `out`; `summary.json` appears last, when the others are there.

    Same tables, same bytes. Errors: `OutputError` when the folder cannot be written.
    """
    contents = {f"{name}.parquet": parquet_bytes(getattr(result, name), table) for name, table in FILES.items()}
    contents["report.html"] = html.render(result)
    contents["junit.xml"] = junit.render(result)
    contents["summary.json"] = summary.render(result)
    publish(out, contents, {"margins.parquet": result.margins_file})
