"""The files of a finished run, written together into one folder, and the formats of `drivelint report`."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING, Final

import pyarrow.compute as pc

from drivelint.result import folder, gate, request
from drivelint.result.files import parquet_bytes
from drivelint.result.names import GATE_FILE, MARK, PICTURES, REPORT_FILES, RESULT_FILES, RUN_FILE, TABLE_OF_FILE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path

    from drivelint.result.model import Result


def _renderer(format_: str) -> Callable[[Result], bytes]:
    """Return the renderer of a report, which loads its module when called: most runs write no report."""

    def render(result: Result) -> bytes:
        rendered: bytes = import_module(f"drivelint.report.{format_}").render(result)
        return rendered

    return render


REPORT_FORMATS: Final[Mapping[str, tuple[str, Callable[[Result], bytes]]]] = {
    name: (file, _renderer(name)) for name, file in REPORT_FILES.items()
}
"""Name -> file in the result folder, and its renderer: the same result gives the same bytes."""


@contextmanager
def working_folder(out: Path | None, *, overwrite: bool = False) -> Iterator[Path | None]:
    """Prepare the folder `out` for a result and yield one within for the files that grow during a run; None: nothing is written.

    Reports of an earlier result go now; if the run ends without a result, the rest of that one moves to `earlier/`.

    Errors: `UsageError` where it has files of such names that drivelint did not write, and may not overwrite them; `OutputError`.
    """
    if out is None:
        yield None
    else:
        reports = list(REPORT_FILES.values())
        with folder.working_folder(out, RESULT_FILES, reports, MARK, overwrite=overwrite) as work:
            yield work


def write(result: Result, out: Path, work: Path | None = None, *, overwrite: bool = False) -> tuple[str, ...]:
    """Write every result file of `check` into the folder `out`, in place of an earlier result.

    `work`: what `working_folder` gave, whose files are taken over. `summary.json` appears last, when the others are there.
    Same tables, same bytes. Return the names of the files that grew during the run.
    Errors: `OutputError` when the folder cannot be written.
    """
    from drivelint.report import html, junit, summary

    contents = {f"{name}.parquet": parquet_bytes(getattr(result, name), table) for name, table in TABLE_OF_FILE.items()}
    for name, table in PICTURES.items() if result.pictures.num_rows else ():
        contents[f"{name}.parquet"] = parquet_bytes(getattr(result, name), table)
    # what lies beside the page is what this run made, not what an earlier one left
    contents[REPORT_FILES["html"]] = html.render(replace(result, folder=work or out))
    contents[REPORT_FILES["junit"]] = junit.render(result)
    if result.gate is not None:
        contents[GATE_FILE] = gate.render(result.gate)
    if result.run_options is not None:
        contents[RUN_FILE] = request.render(result.run_options, out)
    contents[MARK] = summary.render(result)
    moved = {} if result.margins_file is None else {"margins.parquet": result.margins_file}
    if work is not None:
        moved |= _grown(work, result)
    folder.replace(out, contents, moved, MARK, RESULT_FILES, overwrite=overwrite)
    return tuple(sorted(moved))


def _grown(work: Path, result: Result) -> dict[str, Path]:
    """Return name -> file, of those that grew during a run and are of its result."""
    judged = set(result.drives.filter(pc.equal(result.drives["status"], "judged"))["drive_id"].to_pylist())
    files = [path for path in sorted(work.rglob("*")) if path.is_file() and not path.name.startswith(".")]
    # a drive may be annotated before it turns out that it cannot be judged to its end
    return {path.relative_to(work).as_posix(): path for path in files if path.suffix != ".mcap" or path.stem in judged}
