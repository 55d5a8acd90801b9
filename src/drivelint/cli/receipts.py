"""The receipts of `check`: repeats the output of an earlier run with the same inputs, and stores a receipt of this run.

A run is stored if its result depends only on its inputs, and if it wrote only stdout and the files of a result. So it is not stored with
--keep-db or --evidence, after an interruption, with an unjudged drive or a rule in error, or if its logs are its own outputs.
"""

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any, Final

from drivelint.cli.restart import UNSTOPPABLE_RULES_VARIABLE
from drivelint.drivelint_files import written_files
from drivelint.memo import cache_folder
from drivelint.receipts import store
from drivelint.receipts.program import receipt_key
from drivelint.receipts.recorder import InputRecorder, record_inputs
from drivelint.report.progress import NotePrinter
from drivelint.result import folder
from drivelint.result.names import MARK_FILE, REPORT_FILES, RESULT_FILE_GLOBS
from drivelint.settings import SETTINGS_FILE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from datetime import date
    from pathlib import Path

    from drivelint.engine.interruption import Interruption
    from drivelint.gate import GateInputs
    from drivelint.result.model import Result

_CHECK_OPTIONS_WITHOUT_EFFECT: Final = frozenset({"cache", "jobs", "quiet", "today"})
"""Options that do not affect a stored result. With waivers, the receipt stores the day separately."""
_INPUT_FILES_NAMED_BY_NO_OPTION: Final = (SETTINGS_FILE, "proj.ini")
"""Files of the working folder that are read although no option names them: settings, and PROJ's configuration, if it exists."""
_SUBFOLDERS_OF_OUTPUTS: Final = frozenset(
    {"annotated", folder.EARLIER_RESULT_FOLDER, f"{folder.EARLIER_RESULT_FOLDER}/annotated"}
)
_REPEATED_RESULT_NOTE: Final = (
    "nothing has changed since an earlier run: these are its verdicts (--no-cache judges again)"
)


class OutputPathTest:
    """The files that `check` writes into the folder `out`; None: it writes no files."""

    def __init__(self, out: Path | None) -> None:
        self._root = None if out is None else os.path.realpath(out)

    def __call__(self, path: str) -> bool:
        """Return whether a path is an output, or a subfolder of `out` with outputs only. `path`: absolute, links resolved."""
        if self._root is None or not path.startswith(self._root + os.sep):
            return False
        name = path[len(self._root) + 1 :].replace(os.sep, "/")
        if name in _SUBFOLDERS_OF_OUTPUTS:
            with suppress(OSError):
                return all(self(os.path.join(path, entry)) for entry in os.listdir(path))  # noqa: PTH118, PTH208
        name = name.removeprefix(f"{folder.EARLIER_RESULT_FOLDER}/")
        return name.startswith(".drivelint.") or any(fnmatchcase(name, pattern) for pattern in RESULT_FILE_GLOBS)


class StoredRunOfCheck:
    """The receipt of an earlier run of a check, and the receipt that this run stores.

    `options`: the options of `check`; `settings`: the settings file that sets some of them; `day`: the date for waivers.
    """

    def __init__(self, options: Mapping[str, Any], day: date, settings: Path | None) -> None:
        self._out: Path | None = options["out"]
        self._overwrite: bool = options["overwrite"]
        self._quiet: bool = options["quiet"]
        self._day = day.isoformat()
        paths = [*(options[name] for name in ("baseline", "waivers", "map", "map_dir", "mapping")), settings]
        self._named = [*options["traces"], *(options["rules_dir"] or ()), *(path for path in paths if path is not None)]
        self._is_output = OutputPathTest(self._out)
        self._recorder: InputRecorder | None = None
        self._key: str | None = None
        elsewhere = options["keep_db"] or options["evidence"] is not None or UNSTOPPABLE_RULES_VARIABLE in os.environ
        if (
            options["cache"]
            and not elsewhere
            and cache_folder() is not None
            and not self._contains_outputs(self._named)
        ):
            effective = {name: value for name, value in options.items() if name not in _CHECK_OPTIONS_WITHOUT_EFFECT}
            places = {
                name: os.path.realpath(options[name]) for name in ("out", "baseline") if options[name] is not None
            }
            places |= {} if settings is None else {"settings": os.path.realpath(settings)}
            self._key = receipt_key({**effective, "places": places})

    def repeat_earlier_run(self) -> store.Receipt | None:
        """Write the files of an earlier run with the same inputs, and return its receipt; None without such a run.

        Errors: `UsageError` or `OutputError` if the folder cannot be written, as for any run.
        """
        if self._key is None:
            return None
        with store.open_receipt(self._key) as earlier:
            if earlier is None or earlier.receipt.day not in {None, self._day}:
                return None
            if not earlier.receipt.inputs.are_unchanged(self._is_output):
                return None
            if self._out is not None:
                self._write_files_of_receipt(earlier, self._out)
            if not self._quiet:
                notes = NotePrinter()
                for text in (*earlier.receipt.notes, _REPEATED_RESULT_NOTE):
                    notes.note(text)
            return earlier.receipt

    def _write_files_of_receipt(self, receipt: store.OpenedReceipt, out: Path) -> None:
        overwrite, reports = self._overwrite, list(REPORT_FILES.values())
        with folder.working_folder(out, RESULT_FILE_GLOBS, reports, MARK_FILE, overwrite=overwrite) as work:
            contents, finished_files = receipt.unpack(work)
            folder.replace_result(out, contents, finished_files, MARK_FILE, RESULT_FILE_GLOBS, overwrite=overwrite)

    @contextmanager
    def record_inputs(self) -> Iterator[None]:
        """Record the files that are read inside the block, if a receipt of the run may be stored."""
        if self._key is None:
            yield
            return
        with record_inputs(self._is_output, [*_INPUT_FILES_NAMED_BY_NO_OPTION, *self._named]) as self._recorder:
            yield

    def store_receipt(
        self,
        result: Result,
        stdout: str,
        exit_code: int,
        *,
        files_written_while_judging: tuple[str, ...],
        gate: GateInputs | None,
        interruption: Interruption,
    ) -> None:
        """Store a receipt of a finished run, if possible. `files_written_while_judging`: their names."""
        if self._key is None or self._recorder is None or interruption.requested or not _depends_on_inputs_only(result):
            return
        if result.run_options is None or self._contains_outputs(result.run_options.traces.values()):
            return
        inputs = self._recorder.end_recording_and_return_inputs()
        if inputs is None:
            return
        day = self._day if gate is not None and gate.waivers else None
        with suppress(OSError):
            names = (
                []
                if self._out is None
                else sorted(written_files(self._out), key=lambda name: (name == MARK_FILE, name))
            )
            sizes = {name: (self._out / name).stat().st_size for name in names} if self._out else {}
            receipt = store.Receipt(inputs, stdout, result.notes, exit_code, day, sizes, files_written_while_judging)
            store.store_receipt(self._key, receipt, self._out)

    def _contains_outputs(self, paths: Iterator[str] | Any) -> bool:
        return any(self._is_output(os.path.realpath(path)) for path in paths)


def _depends_on_inputs_only(result: Result) -> bool:
    """Return whether a result is complete and depends only on its inputs: a drive or rule in error may succeed next time."""
    is_judged = set(result.drives["status"].to_pylist()) <= {"judged"}
    return is_judged and not result.interrupted and "error" not in result.verdicts["verdict"].unique().to_pylist()
