"""The result of a check as a Python object."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final, overload

from drivelint.api.arguments import with_argument_checks
from drivelint.api.explained import Explained
from drivelint.api.keywords import replace_options_by_keywords, rewrite_options_in_errors
from drivelint.api.notebook import one_line_summary, summary_html
from drivelint.api.tables import Table, TableSet
from drivelint.api.timeline import Timeline, timeline
from drivelint.errors import UsageError
from drivelint.explain import ExplainRequest, VerdictFilter, explain
from drivelint.options.types import ReportFormat, require_one_of, to_path
from drivelint.report import outputs
from drivelint.result.model import exit_status
from drivelint.result.names import TABLE_OF_FILE, TABLE_OF_PICTURE_FILE
from drivelint.result.publishing import publish

if TYPE_CHECKING:
    from drivelint.options.types import AnyPath
    from drivelint.result.model import Result

_MARGINS_FILE: Final = "margins.parquet"


class CheckResult(TableSet):
    """The result of `check`, or of `open`: its tables, its exit code, and its reports.

    The tables are those of the result files: `drivelint docs columns` describes their columns. `notes`: the messages that the command
    line prints on stderr. `folder`: the folder of the result files; None if they were not written.
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
    pictures: Table

    def __init__(
        self,
        result: Result,
        folder: Path | None = None,
        notes: tuple[str, ...] = (),
        scratch: TemporaryDirectory[str] | None = None,
    ) -> None:
        kinds = {**TABLE_OF_FILE, **TABLE_OF_PICTURE_FILE}
        super().__init__({name: getattr(result, name) for name in kinds}, schema_tables=kinds)
        for name, table in self.tables.items():
            setattr(self, name, table)
        self.notes = tuple(map(replace_options_by_keywords, notes))
        self.folder = folder
        self._result = replace(result, margins_file=None)
        self._scratch = scratch  # the folder, with the margins, is removed with the last reference to the result
        margins = result.margins_file if folder is None else folder / _MARGINS_FILE
        self._margins_file = margins if margins is not None and margins.is_file() else None

    @property
    def result(self) -> Result:
        """The internal form of the result; not part of the public interface."""
        return self._result

    @property
    def exit_code(self) -> int:
        """The exit code of `drivelint check`: 0 nothing failed, 1 something failed, 2 rule error, 3 lossy input, 4 not judged."""
        return int(exit_status(self._result).code)

    @property
    def why(self) -> str:
        """The reason for the exit code, in one sentence."""
        return replace_options_by_keywords(exit_status(self._result).why)

    @property
    def margins(self) -> Table | None:
        """The table of every judged step; None if `check` ran without `margins`."""
        if self._margins_file is None:
            return None
        import pyarrow.parquet as pq

        return Table(pq.read_table(self._margins_file), "margin")

    @overload
    def report(self, path: None = None, *, to: ReportFormat = "html") -> str: ...
    @overload
    def report(self, path: AnyPath, *, to: ReportFormat = "html") -> Path: ...
    @with_argument_checks
    def report(self, path: AnyPath | None = None, *, to: ReportFormat = "html") -> str | Path:
        """Return a report as text; or, with `path`, write it to this file and return the path.

        `to`: html, junit, sarif, xqar, markdown. Errors: `DriveLintError` if the file cannot be written.
        """
        _, render = outputs.REPORT_FORMATS[require_one_of("to", to, ReportFormat)]
        content = render(self._result)
        if path is None:
            return content.decode()
        file = Path(path)
        if file.is_dir():
            raise UsageError(f"{file} is a folder: name the file, such as {file / 'report.html'}")
        publish(file.parent, {file.name: content}, {})
        return file

    @with_argument_checks
    def write(self, folder: AnyPath, *, overwrite: bool = False) -> Path:
        """Write the result files into a folder, as `check --out` does, and return the folder.

        Nothing is written if the result is already in this folder. Annotated logs and the kept database are not written: they need the
        logs, so only `check` writes them, into its `out`. Errors: `DriveLintError` if the folder cannot be written, or, without
        `overwrite`, has result files that drivelint did not write.
        """
        if not str(folder).strip():
            raise UsageError("an empty folder name was given: name the folder")
        out = Path(folder)
        if self.folder is not None and out.resolve() == self.folder.resolve():
            return out
        with rewrite_options_in_errors(), outputs.working_folder(out, overwrite=overwrite) as work:
            margins = None
            if work is not None and self._margins_file is not None:
                margins = shutil.copyfile(self._margins_file, work / _MARGINS_FILE)
            outputs.write(replace(self._result, margins_file=margins), out, overwrite=overwrite)
        return out

    @with_argument_checks
    def explain(
        self,
        name: str,
        *,
        profile: str | None = None,
        object: str | int | None = None,  # noqa: A002 - the option's name
        ego: str | int | None = None,
        verdict: str | None = None,
        at: float | None = None,
        trace: AnyPath | None = None,
        map: AnyPath | None = None,  # noqa: A002 - the option's name
    ) -> Explained:
        """Explain one verdict, as `drivelint explain` does: the rule judges the drive again.

        `name`: the id of a finding, RULE or RULE@DRIVE, each of which may be shortened to its beginning. `profile`, `object`, `ego`,
        `verdict` and `at` choose among several verdicts. `trace`, `map`: the new paths of the log and the map, if they were moved.
        Errors: `DriveLintError`.
        """
        verdict_filter = VerdictFilter(profile, _text_or_none(object), at, _text_or_none(ego), verdict)
        with TemporaryDirectory(prefix="drivelint-") as scratch:
            folder = self.folder or self.write(scratch)
            return Explained(explain(ExplainRequest(name, folder, verdict_filter, to_path(trace), to_path(map))))

    @with_argument_checks
    def timeline(self, finding: str) -> Timeline:
        """Return a finding over time: gap, speeds, accelerations, and the measured value of its rule.

        `finding`: its id or the beginning of its id, RULE or RULE@DRIVE. `.plot()` draws the timeline. Errors: `DriveLintError`.
        """
        return timeline(self._result, finding)

    def _queryable_tables(self) -> dict[str, Any]:
        queried = super()._queryable_tables()
        if self._margins_file is not None:
            import pyarrow.dataset as ds

            queried["margins"] = ds.dataset(self._margins_file)  # a query reads only the parts that it needs
        return queried

    def __repr__(self) -> str:
        return f"<drivelint.CheckResult: {one_line_summary(self._result)}; exit code {self.exit_code}>"

    def _repr_html_(self) -> str:
        return summary_html(self._result)


def _text_or_none(value: str | int | None) -> str | None:
    return None if value is None else str(value)
