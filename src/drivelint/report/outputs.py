"""Writes the files of a finished run together into one folder; lists the formats of `drivelint report`."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING, Final

import pyarrow.compute as pc

from drivelint.errors import UsageError
from drivelint.result import folder, gate, request
from drivelint.result.files import parquet_bytes
from drivelint.result.names import (
    GATE_FILE,
    MARK_FILE,
    REPORT_FILES,
    RESULT_FILE_GLOBS,
    RUN_FILE,
    TABLE_OF_FILE,
    TABLE_OF_PICTURE_FILE,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from drivelint.result.model import Result


def _renderer(format_: str) -> Callable[[Result], bytes]:
    """Return the renderer of a report, which imports the report's module only when called: most runs write no report."""

    def render(result: Result) -> bytes:
        rendered: bytes = import_module(f"drivelint.report.{format_}").render(result)
        return rendered

    return render


REPORT_FORMATS: Final[Mapping[str, tuple[str, Callable[[Result], bytes]]]] = {
    name: (file, _renderer(name)) for name, file in REPORT_FILES.items()
}
"""The file of each format in the result folder, and its renderer, which writes the same bytes for the same result."""


@contextmanager
def working_folder(out: Path | None, formats: Sequence[str] = (), *, overwrite: bool = False) -> Iterator[Path | None]:
    """Prepare the folder `out` for a result, and yield a folder in it for files that grow during a run. If `out` is None, yield None.

    Reports of an earlier result are removed at once. If the run ends without a result, the earlier result's other files move to
    `earlier/`.

    Errors: `UsageError` if `out` has result files that drivelint did not write, unless `overwrite`, or if it is None although reports
    of some `formats` are to be written; `OutputError`.
    """
    if out is None and formats:
        raise UsageError("--report: needs a folder for the report: name it with --out")
    if out is None:
        yield None
    else:
        reports = list(REPORT_FILES.values())
        with folder.working_folder(out, RESULT_FILE_GLOBS, reports, MARK_FILE, overwrite=overwrite) as work:
            yield work


def write(
    result: Result, out: Path, work: Path | None = None, *, reports: Sequence[str] = (), overwrite: bool = False
) -> tuple[str, ...]:
    """Write every result file of `check` into the folder `out`, and replace an earlier result.

    `work`: the folder that `working_folder` yielded; its files become part of the result. `summary.json` is written last.
    `reports`: further formats of `REPORT_FORMATS` to write.
    The same tables give the same bytes. Return the names of the files that grew during the run.
    Errors: `OutputError` if the folder cannot be written.
    """
    from drivelint.report import html, junit, summary

    contents = {f"{name}.parquet": parquet_bytes(getattr(result, name), table) for name, table in TABLE_OF_FILE.items()}
    for name, table in TABLE_OF_PICTURE_FILE.items() if result.pictures.num_rows else ():
        contents[f"{name}.parquet"] = parquet_bytes(getattr(result, name), table)
    # the page links to files in the folder of this run, not to files of an earlier run
    contents[REPORT_FILES["html"]] = html.render(replace(result, folder=work or out))
    contents[REPORT_FILES["junit"]] = junit.render(result)
    contents |= {
        name: render(result) for name, render in (REPORT_FORMATS[report] for report in reports) if name not in contents
    }
    if result.gate is not None:
        contents[GATE_FILE] = gate.render(result.gate)
    if result.run_options is not None:
        contents[RUN_FILE] = request.render(result.run_options, out)
    contents[MARK_FILE] = summary.render(result)
    moved_files = {} if result.margins_file is None else {"margins.parquet": result.margins_file}
    if work is not None:
        moved_files |= _result_files_in_work(work, result)
    folder.replace_result(out, contents, moved_files, MARK_FILE, RESULT_FILE_GLOBS, overwrite=overwrite)
    return tuple(sorted(moved_files))


def _result_files_in_work(work: Path, result: Result) -> dict[str, Path]:
    """Return the files in `work` that belong to the result, by name."""
    judged_ids = set(result.drives.filter(pc.equal(result.drives["status"], "judged"))["drive_id"].to_pylist())
    files = [path for path in sorted(work.rglob("*")) if path.is_file() and not path.name.startswith(".")]
    # without annotated logs of drives that could not be judged completely
    return {
        path.relative_to(work).as_posix(): path for path in files if path.suffix != ".mcap" or path.stem in judged_ids
    }
