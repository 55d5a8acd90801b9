"""The incident sheet (two A4 pages about one finding or near miss, for a claims handler) and the clip of the log around a finding."""

from __future__ import annotations

import base64
import hashlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Final

import duckdb
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from drivelint import __version__
from drivelint.catalogue.header import CONTACT_TAG
from drivelint.engine.memory import DEFAULT_MEMORY_BYTES
from drivelint.engine.robustness.copies import MeasurementErrors
from drivelint.explain.source import open_judged_drive_and_source_text, with_ego
from drivelint.incident import pdf, sheet
from drivelint.incident.case import Case
from drivelint.incident.finding import contact_findings, named_finding, near_miss_with_closing_speed, near_misses
from drivelint.incident.judge import EgoRows, Judge
from drivelint.report import html as report_page
from drivelint.report.html.anchors import anchor
from drivelint.report.html.environment import PICTURE_STYLE_FILE, escape_for_page
from drivelint.result import request as run_request
from drivelint.result.compiled_templates import CompiledTemplates
from drivelint.result.load import load_result
from drivelint.result.publishing import publish
from drivelint.result.text import measure, number

if TYPE_CHECKING:
    from drivelint.incident.finding import NamedFinding
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

FOLDER: Final = "incidents"
"""The subfolder of the result folder that contains the sheets; each file has the finding's id as its name."""
_HERE: Final = Path(__file__).parent
_REPORT_TEMPLATES: Final = Path(report_page.__file__).parent / "templates"
_NON_VEHICLE_CLASSES: Final = frozenset({"pedestrian", "animal", "object"})


@dataclass(frozen=True)
class IncidentRequest:
    """A request to `report --incident`: a finding or near miss, named as for `explain`, and the paths of log and map if they were moved."""

    name: str
    folder: Path
    pdf: bool = False
    trace: Path | None = None
    map: Path | None = None
    memory: int | None = DEFAULT_MEMORY_BYTES


def write_sheet(request: IncidentRequest) -> list[Path]:
    """Write the sheet of a finding or near miss into the result folder and return the paths of its files.

    Errors: `UsageError` if the finding, log or map does not exist, or if no installed browser can print a PDF.
    """
    browser = pdf.find_browser() if request.pdf else None
    case = judge_parties_again(request)
    name, page = case.finding.row["finding_id"], sheet_html(case)
    contents = {f"{name}.html": page}
    if browser is not None:
        contents[f"{name}.pdf"] = pdf.pdf_of_page(page, browser)
    publish(request.folder / FOLDER, contents, {})
    return [request.folder / FOLDER / name for name in contents]


def other_drives_with_named_finding(request: IncidentRequest) -> list[str]:
    """Return the other drives with findings that match the name; they exist only if the name is a rule, or `contact`, without a drive.

    If no drive has such a finding, return the other drives with near misses.
    """
    result = load_result(request.folder)
    finding = named_finding(result, request.name, with_near_misses=True)
    row = finding.row
    if "@" in request.name or row["finding_id"].startswith(request.name):
        return []
    every = near_misses(result) if finding.is_near_miss else result.findings.select(["rule_id", "drive_id"]).to_pylist()
    same = (
        contact_findings(result)
        if request.name == CONTACT_TAG
        else [candidate for candidate in every if candidate["rule_id"] == row["rule_id"]]
    )
    return sorted({candidate["drive_id"] for candidate in same} - {row["drive_id"]})


def possible_sheet_ids(result: Result) -> set[str]:
    """Return the ids of all findings and near misses of a result; the file of a sheet has its id as name."""
    return {*result.findings["finding_id"].to_pylist(), *(row["finding_id"] for row in near_misses(result))}


def sheet_html(case: Case) -> bytes:
    """Return the sheet as one HTML page that opens offline; the same case gives the same bytes."""
    text = _template_environment().get_template("sheet.html.j2").render(sheet.template_values(case))
    return text.encode("utf-8", "replace")


def judge_parties_again(request: IncidentRequest, run_options: RunRequest | None = None) -> Case:
    """Find the finding and judge both parties again; for another party that was an ego of the run, the run's result is used.

    `run_options`: the run's options with the current paths of its files; None: the paths are those of `run.json`.
    Errors: `UsageError` if the finding, log or map does not exist.
    """
    result = load_result(request.folder)
    finding = named_finding(result, request.name, with_near_misses=True)
    run_options = (run_options or run_request.load(request.folder)).of_drive(finding.row["drive_id"])
    judge = Judge.of_run(run_options, result.rules, request.memory)
    ego, other_id = finding.row["ego_id"], finding.row["object_id"]
    drive, source = open_judged_drive_and_source_text(
        request.folder,
        run_options,
        finding.row["drive_id"],
        ego,
        trace=_present_log_path(request, run_options, finding),
        map_=request.map,
        map_sha256=finding.drive["map_sha256"],
    )
    ego_rows = judge.judge(drive, ego, other_id)
    if finding.is_near_miss:
        finding = near_miss_with_closing_speed(finding, ego_rows.steps)
    return Case(
        result,
        run_options,
        finding,
        drive,
        ego_rows,
        _other_party_rows_or_reason(request, run_options, result, finding, judge),
        source,
    )


def _other_party_rows_or_reason(
    request: IncidentRequest, run_options: RunRequest, result: Result, finding: NamedFinding, judge: Judge
) -> EgoRows | str | None:
    """Return the result for the other party as ego, or a sentence why it was not judged; None if there is no other party."""
    other_id, drive_id = finding.row["object_id"], finding.row["drive_id"]
    if other_id is None:
        return None
    if any(ego["ego_id"] == other_id for ego in finding.drive["exposure"]):
        rows = [
            [row for row in table.to_pylist() if row["drive_id"] == drive_id and row["ego_id"] == other_id]
            for table in (result.verdicts, result.findings)
        ]
        return EgoRows(rows[0], rows[1], result.verdicts.slice(0, 0))
    # the option --ego-size is about the ego of the run: with this option, read the log with that ego
    read_as = other_id if run_options.ego_size is None else finding.row["ego_id"]
    drive, _ = open_judged_drive_and_source_text(
        request.folder,
        run_options,
        drive_id,
        read_as,
        trace=_present_log_path(request, run_options, finding),
        map_=request.map,
    )
    drive = with_ego(drive, other_id)
    kinds = {row["actor_id"]: row["actor_class"] for row in drive.trace.tables["actor"].to_pylist()}
    if kinds.get(other_id) in _NON_VEHICLE_CLASSES:
        return f"The rules are for drivers: {other_id} is a {kinds[other_id]}, and was not judged."
    examined = any(row["n_copies"] is not None for row in result.findings.to_pylist())
    return judge.judge(drive, other_id, finding.row["ego_id"], MeasurementErrors() if examined else None)


def _present_log_path(request: IncidentRequest, run_options: RunRequest, finding: NamedFinding) -> Path | None:
    """Return the log's path, from which the log is read even if a database was kept; None if there is no log at that path."""
    if request.trace is not None:
        return request.trace
    path = run_options.traces.get(finding.row["drive_id"])
    return Path(path) if path is not None and Path(path).exists() else None


@cache
def _template_environment() -> Environment:
    environment = Environment(
        finalize=escape_for_page,
        bytecode_cache=CompiledTemplates("incident"),
        loader=FileSystemLoader([_HERE, _REPORT_TEMPLATES]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # the plan view has the same style as in the report
    files = (_REPORT_TEMPLATES / "charts.css", _HERE / "sheet.css")
    style = "\n".join(file.read_text(encoding="utf-8").strip() for file in files)
    pictures = (_REPORT_TEMPLATES / PICTURE_STYLE_FILE).read_text(encoding="utf-8").strip()
    digest, of_pictures = (
        base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in (style, pictures)
    )
    shared_directives = "base-uri 'none'; form-action 'none'"
    environment.globals.update(
        style=Markup(style),  # noqa: S704 - ours
        picture_style=Markup(pictures),  # noqa: S704 - ours
        policy=f"default-src 'none'; style-src 'sha256-{digest}'; {shared_directives}",
        picture_policy=(
            f"default-src 'none'; style-src 'sha256-{digest}' 'sha256-{of_pictures}'; img-src data:; {shared_directives}"
        ),
        version=__version__,
        duckdb_version=duckdb.__version__,
        anchor=anchor,
        number=number,
        figure=sheet.number_or_dash,
    )
    environment.filters["measure"] = measure
    return environment
