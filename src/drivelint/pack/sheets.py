"""Puts the incident sheets of a result into its pack. Each page is written again from the log, which reveals a page that was changed."""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, Final

from drivelint import incident

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

SHEETS_FOLDER: Final = "data/incidents"
_PAGE_SUFFIX: Final = ".html"
_PDF_SUFFIX: Final = ".pdf"


def sheets_of_result(folder: Path, result: Result, check_request: RunRequest) -> dict[str, bytes]:
    """Return path in the pack -> content of the incident sheets in a result folder that belong to its findings or near misses.

    `check_request` has the paths of the logs. A PDF is included only if the HTML page beside it equals the page that is written again.
    """
    ids = incident.possible_sheet_ids(result)
    sheets = {}
    for page in sorted((folder / incident.FOLDER).glob(f"*{_PAGE_SUFFIX}")):
        if page.stem in ids:
            content = _sheet_page(folder, page.stem, check_request)
            pdf = page.with_suffix(_PDF_SUFFIX)
            sheets[f"{SHEETS_FOLDER}/{page.name}"] = content
            if pdf.is_file() and page.read_bytes() == content:
                sheets[f"{SHEETS_FOLDER}/{pdf.name}"] = pdf.read_bytes()
    return sheets


def pages_written_again(
    result_folder: Path, evidence: Mapping[str, Any], check_request: RunRequest
) -> dict[str, bytes]:
    """Write the pages of a pack again from its logs; return path in the pack -> content. `result_folder`: folder of the result in the
    pack."""
    pages = [name for name in sheet_paths_in_evidence(evidence) if name.endswith(_PAGE_SUFFIX)]
    return {name: _sheet_page(result_folder, PurePosixPath(name).stem, check_request) for name in pages}


def sheet_paths_in_evidence(evidence: Mapping[str, Any]) -> list[str]:
    """Return the files of incident sheets that `evidence.json` names. Without sheets, the file lacks this key."""
    return list(evidence.get("incidents", ()))


def has_sheet_as_pdf(evidence: Mapping[str, Any]) -> bool:
    """Return whether a pack contains a PDF of an incident sheet, whose bytes cannot be written again."""
    return any(name.endswith(_PDF_SUFFIX) for name in sheet_paths_in_evidence(evidence))


def invalid_sheets(folder: Path, evidence: Mapping[str, Any], possible_ids: Iterable[str]) -> list[str]:
    """Return the files of sheets in `evidence.json` that belong to no finding or near miss, do not exist, or are a PDF without its page."""
    pages = {f"{SHEETS_FOLDER}/{sheet_id}{_PAGE_SUFFIX}" for sheet_id in possible_ids}
    paths = sheet_paths_in_evidence(evidence)
    due = pages | {name.removesuffix(_PAGE_SUFFIX) + _PDF_SUFFIX for name in pages & set(paths)}
    return [name for name in paths if name not in due or not (folder / name).is_file()]


def _sheet_page(folder: Path, finding_id: str, check_request: RunRequest) -> bytes:
    return incident.sheet_html(
        incident.judge_parties_again(incident.IncidentRequest(finding_id, folder), check_request)
    )
