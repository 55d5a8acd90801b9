"""The difference of two results as a Python object."""

from __future__ import annotations

import json
import reprlib
from dataclasses import asdict
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint.api.check_result import CheckResult
from drivelint.api.notebook import preformatted_html
from drivelint.errors import UsageError
from drivelint.gate import compare_results, descriptions
from drivelint.options.types import FailOn, require_one_of
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from drivelint.gate import ComparedFinding, Difference
    from drivelint.options.types import AnyPath
    from drivelint.result.gate import Gate
    from drivelint.result.model import Result


class Comparison:
    """The content of `drivelint diff` for two results."""

    def __init__(
        self, difference: Difference, failing: list[ComparedFinding], least_severity: str, gate: Gate | None
    ) -> None:
        self._difference, self._failing, self._least_severity, self._gate = difference, failing, least_severity, gate

    @property
    def exit_code(self) -> int:
        """The exit code of `drivelint diff`. 1: a new finding that gates; 4: none, but an earlier finding is absent and not fixed."""
        return int(descriptions.exit_code(self._difference, self._failing, self._least_severity))

    @property
    def text(self) -> str:
        """The text that `drivelint diff` prints."""
        return descriptions.difference_text(self._difference, self._failing, self._least_severity, self._gate)

    def findings(self) -> list[dict[str, Any]]:
        """Return every finding of both results. `standing`: new, changed, unchanged, fixed, elsewhere, unknown or lost."""
        return [asdict(entry) for entry in self._difference.entries]

    def data(self) -> dict[str, Any]:
        """Return the output of `drivelint diff --format json` as plain data."""
        document: dict[str, Any] = json.loads(
            descriptions.to_json(self._difference, self._failing, self._least_severity)
        )
        return document

    def __repr__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return preformatted_html(self.text)


def diff(base: CheckResult | AnyPath, new: CheckResult | AnyPath, *, fail_on: FailOn | None = None) -> Comparison:
    """Compare two results, or the folders with them: new, fixed, changed and unchanged findings.

    `fail_on`: lowest severity of a new finding that causes exit code 1; None: the `fail_on` of the check `new`. Errors: `DriveLintError`.
    """
    (earlier, base_name), (later, name) = _load_result_and_name(base, "base"), _load_result_and_name(new, "new")
    least = later.fail_on if fail_on is None else require_one_of("fail_on", fail_on, FailOn)
    difference, failing = compare_results(earlier, later, (base_name, name), least)
    return Comparison(difference, failing, least, later.gate)


def _load_result_and_name(source: CheckResult | AnyPath, name: str) -> tuple[Result, str]:
    """Return a result and its name: the name of its folder, else `name`."""
    if isinstance(source, CheckResult):
        return source.result, name if source.folder is None else source.folder.resolve().name
    if not isinstance(source, str | PathLike):
        raise UsageError(f"{name}={reprlib.repr(source)}: give a result, or its folder")
    return load_result(Path(source)), Path(source).resolve().name
