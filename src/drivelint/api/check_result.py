"""What a check found, for whoever asks it in Python."""

from __future__ import annotations

import shutil
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, overload

from drivelint.api.notebook import summary_html
from drivelint.api.options import ReportFormat, one_of
from drivelint.api.tables import Table, TableSet
from drivelint.report import outputs
from drivelint.report.terminal_summary import verdict_line
from drivelint.result.files import prepare_folder, publish
from drivelint.result.model import exit_status
from drivelint.result.schemas import TABLE_OF_FILE

if TYPE_CHECKING:
    from drivelint.api.options import AnyPath
    from drivelint.result.model import Result

_MARGINS: Final = "margins.parquet"


class CheckResult(TableSet):
    """The result of `check`, or of the folder that it wrote: its tables, its outcome, and reports of it.

    The tables are those of the result files: `drivelint docs columns` describes their columns. `notes`: what the command line
    would have said on stderr.
    """

    verdicts: Table
    findings: Table
    drives: Table
    rules: Table
    scenes: Table
    lanes: Table
    spaces: Table
    courses: Table
    tracks: Table
    overtakes: Table
    opportunities: Table

    def __init__(self, result: Result, folder: Path | None = None, notes: tuple[str, ...] = ()) -> None:
        super().__init__({name: getattr(result, name) for name in TABLE_OF_FILE})
        for name, table in self.tables.items():
            setattr(self, name, table)
        self.notes = notes
        self._result = result
        self._margins_file = None if folder is None or not (folder / _MARGINS).is_file() else folder / _MARGINS

    @property
    def exit_code(self) -> int:
        """What the command line's exit code is: 0 nothing failed, 1 something did, 3 lossy, 4 not judged, 2 a rule erred."""
        return int(exit_status(self._result).code)

    @property
    def why(self) -> str:
        """Why the exit code is what it is, in one sentence."""
        return exit_status(self._result).why

    @property
    def margins(self) -> Table | None:
        """Every judged step, if `check` was asked for it; None: it was not."""
        if self._margins_file is None:
            return None
        import pyarrow.parquet as pq

        return Table(pq.read_table(self._margins_file))

    @overload
    def report(self, path: None = None, *, to: ReportFormat = "html") -> str: ...
    @overload
    def report(self, path: AnyPath, *, to: ReportFormat = "html") -> Path: ...
    def report(self, path: AnyPath | None = None, *, to: ReportFormat = "html") -> str | Path:
        """Return a report as text; or write it to a file and return its path.

        `to`: html, junit, sarif, xqar, markdown. Errors: `DriveLintError` when the file cannot be written.
        """
        _, render = outputs.REPORT_FORMATS[one_of("to", to, ReportFormat)]
        content = render(self._result)
        if path is None:
            return content.decode()
        file = Path(path)
        publish(file.parent, {file.name: content}, {})
        return file

    def write(self, folder: AnyPath) -> Path:
        """Write the result files into a folder, as `check --out` does, and return it.

        The logs with their verdicts and the kept database need the log: `check` writes them itself, into its `out`.
        Errors: `DriveLintError` when the folder cannot be written.
        """
        out = Path(folder)
        prepare_folder(out)
        with ExitStack() as undo:
            margins = None
            if self._margins_file is not None:
                margins = out / f".copy.{_MARGINS}"
                undo.callback(margins.unlink, missing_ok=True)
                shutil.copyfile(self._margins_file, margins)
            outputs.write(replace(self._result, margins_file=margins), out)
        return out

    def _queried(self) -> dict[str, Any]:
        queried = super()._queried()
        if self._margins_file is not None:
            import pyarrow.dataset as ds

            queried["margins"] = ds.dataset(self._margins_file)  # only what the query needs of it is read
        return queried

    def __repr__(self) -> str:
        return f"<drivelint.CheckResult: {verdict_line(self._result)}; exit code {self.exit_code}>"

    def _repr_html_(self) -> str:
        return summary_html(self._result)
