"""Reads a result back from its folder."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.parquet as pq

from drivelint.errors import DriveLintError, UsageError
from drivelint.phrases import path_hint
from drivelint.result import gate as gates
from drivelint.result.folder import changed_files, folder_of_killed_run
from drivelint.result.geometry import without_geometry
from drivelint.result.model import Result
from drivelint.result.names import TABLE_OF_FILE, TABLE_OF_PICTURE_FILE
from drivelint.result.schemas import OUTPUT_VERSION

if TYPE_CHECKING:
    from pathlib import Path


def load_result(folder: Path) -> Result:
    """Return the result that `check --out` wrote into a folder.

    Errors: `UsageError` for an incomplete or changed result, a result of another version, or an earlier result that a killed run
    should have replaced.
    """
    summary = _summary(folder)
    if left := folder_of_killed_run(folder):
        raise UsageError(
            f"{folder}: of an earlier run: the run that should replace it was killed: check the drives again, or remove {left} to read it"
        )
    if summary.get("output_schema") != OUTPUT_VERSION:
        raise UsageError(
            f"{folder}: written with output schema {summary.get('output_schema')}, this drivelint reads {OUTPUT_VERSION}: "
            "check the drives again"
        )
    tables = {name: _table(folder / f"{name}.parquet") for name in TABLE_OF_FILE}
    tables |= {name: _table(path) for name in TABLE_OF_PICTURE_FILE if (path := folder / f"{name}.parquet").exists()}
    gate = gates.load(folder)
    try:
        result = Result(
            **tables,
            fail_on=summary["fail_on"],
            strict=summary["strict"],
            required=tuple(summary.get("required", ())),  # older results lack this key and the next
            min_judged=summary.get("min_judged"),
            interrupted=summary.get("interrupted", False),
            halted=summary.get("halted"),
            ended_early=summary.get("ended_early"),
            notes=tuple(summary.get("notes", ())),
            gate=gate,
            folder=folder,
        )
    except DriveLintError as error:
        raise UsageError(f"{folder}: of another version of drivelint ({error}): check the drives again") from error
    if wrong := changed_files(folder):
        raise UsageError(f"{folder / wrong[0]}: was changed since drivelint check wrote it: check the drives again")
    return result


def _summary(folder: Path) -> dict[str, Any]:
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        suggestion = "" if folder.exists() else path_hint(folder)
        raise UsageError(
            f"{folder}: no result of drivelint check: summary.json {_file_problem_words(error)}: "
            f"{suggestion or 'name the folder that check --out wrote'}"
        ) from error
    if isinstance(summary, dict) and "digest" in summary and (folder / "audit.json").is_file():
        raise UsageError(
            f"{folder}: this is an audit: give the drive's log to drivelint check with --out, and name that folder; "
            "its findings have the same ids"
        )
    if not isinstance(summary, dict) or not {"fail_on", "strict"} <= summary.keys():
        raise UsageError(
            f"{folder}: no result of drivelint check: summary.json lacks fail_on or strict: name a folder of check --out"
        )
    return summary


def _table(path: Path) -> pa.Table:
    try:
        # Read by Python, since receipts record the files that Python opens. Arrow gets the bytes, not the file: one of its threads may
        # still hold a file of Python when the interpreter ends, which then aborts.
        content = pa.BufferReader(path.read_bytes())
        return without_geometry(pq.read_table(content, page_checksum_verification=True))
    except (OSError, pa.ArrowException, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: {_file_problem_words(error)}: check the drives again") from error


def _file_problem_words(error: Exception) -> str:
    return "is missing" if isinstance(error, FileNotFoundError) else "cannot be read"
