"""Writes an evidence pack: the result, the rules, the data that reproduce each finding, and optionally the logs and the map."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint import __version__
from drivelint.audit.bucket import url_of_path
from drivelint.errors import UsageError
from drivelint.pack import audits, bag, contents, reproduction, sheets, signature, timestamp
from drivelint.pack.contents import EVIDENCE_FILE, RESULT_FOLDER, packed_summary
from drivelint.pack.copying import copy_into_new_folder, copy_rule_files, copy_rules_dirs, write_files
from drivelint.pack.inputs import request_with_present_paths
from drivelint.pack.request import DEFAULT_PACKED_FINDINGS, PackContentFunctions
from drivelint.pack.statement import ENVELOPE_FILE, STATEMENT_FILE, in_toto_statement
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result import request as run_request
from drivelint.result.load import load_result
from drivelint.result.publishing import OutputError

if TYPE_CHECKING:
    from drivelint.catalogue import Rule
    from drivelint.pack.request import PackRequest
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

PUBLIC_KEY_FILE: Final = "public-key.pem"


class _PackSource(NamedTuple):
    """The content for the pack of a check. `incidents`: path in the pack -> content of the incident sheets."""

    result: Result
    check_request: RunRequest
    rules: list[Rule]
    evidence: reproduction.Evidence
    incidents: dict[str, bytes]


def write_pack(request: PackRequest) -> dict[str, Any]:
    """Write the pack and return the content of its `evidence.json`. Nothing exists at `out` until the pack is complete.

    Errors: `UsageError` for a result, log, map, rule or key that is missing or has changed, and if `out` exists without `overwrite`;
    `OutputError`.
    """
    key = signing_key_of_valid_request(request)
    is_audit = audits.is_audit_folder(request.folder)
    if not is_audit and request.findings != DEFAULT_PACKED_FINDINGS:
        raise UsageError("--findings is of an audit: the pack of a check has all of its findings")
    content = audits.functions_that_pack_audit(request) if is_audit else _functions_that_pack_check_result(request)
    try:
        request.out.parent.mkdir(parents=True, exist_ok=True)
        work = Path(mkdtemp(prefix=".drivelint.", dir=request.out.parent))
        try:
            evidence = content.payload(work)
            info = {"External-Description": bag.DESCRIPTION.strip()}
            info |= {} if request.date is None else {"Bagging-Date": request.date}
            bag.write_info_and_manifest(work, {**info, "Bag-Software-Agent": f"drivelint {__version__}"})
            statement = content.statement(work, evidence)
            if key is None:
                (work / STATEMENT_FILE).write_bytes(statement)
            else:
                sealed = signature.signed_envelope(statement, key)
                (work / ENVELOPE_FILE).write_bytes(sealed)
                if request.timestamp is not None:
                    (work / timestamp.TIMESTAMP_FILE).write_bytes(timestamp.read_response(request.timestamp, sealed))
                (work / PUBLIC_KEY_FILE).write_bytes(signature.public_key_pem(key.public_key()))
            bag.write_tag_manifest(work)
            work.chmod(0o755)
            if request.out.exists():
                shutil.rmtree(request.out)
            work.rename(request.out)
        finally:
            shutil.rmtree(work, ignore_errors=True)
    except OSError as error:
        raise OutputError(f"{request.out}: cannot write the pack: {error.strerror or error}") from error
    return evidence


def signing_key_of_valid_request(request: PackRequest) -> signature.SigningKey | None:
    """Return the key that signs a pack; None: the pack is not signed. Errors: `UsageError` for an invalid request, or if `out` exists
    without `overwrite`."""
    if (url := url_of_path(request.folder)) is not None:
        raise UsageError(f"{url}: is in an object store: copy it into a folder of this machine and pack that")
    if (url := url_of_path(request.out)) is not None:
        raise UsageError(f"{url}: a pack is a folder of this machine: write it here and copy it there")
    if request.timestamp is not None and request.key is None:
        raise UsageError("--timestamp is for a signed statement: use --sign with the key, too")
    key = None if request.key is None else signature.signing_key(request.key)
    _refuse_occupied_folder(request.out, overwrite=request.overwrite)
    if request.out.resolve().is_relative_to(request.folder.resolve()):
        raise UsageError(f"{request.out}: lies in the result that is packed: choose a folder beside it")
    return key


def _refuse_occupied_folder(out: Path, *, overwrite: bool) -> None:
    if not out.exists() or (out.is_dir() and not any(out.iterdir())):
        return
    if not out.is_dir() or not (out / bag.DECLARATION).is_file() or not (out / EVIDENCE_FILE).is_file():
        raise UsageError(f"{out}: is there and is no evidence pack: choose another folder")
    if not overwrite:
        raise UsageError(f"{out}: has a pack: choose another folder, or replace it with drivelint pack --overwrite")


def _functions_that_pack_check_result(request: PackRequest) -> PackContentFunctions:
    """Return the functions that pack the result of a check. The logs are judged again here, before anything is written."""
    result = load_result(request.folder)
    check_request = run_request.load(request.folder)
    if check_request.manifest_options:
        raise UsageError(
            f"{request.folder}: its logs have options of their own, by a manifest: audit that, and pack the audit"
        )
    check_request = request_with_present_paths(check_request, result.drives.to_pylist(), request.traces, request.map)
    rules, evidence = (
        reproduction.rules_of_result(result, check_request),
        reproduction.evidence_of_findings(result, check_request),
    )
    checked_result = _PackSource(
        result, check_request, rules, evidence, sheets.sheets_of_result(request.folder, result, check_request)
    )
    return PackContentFunctions(
        lambda work: _write_payload_and_return_evidence(work, request, checked_result),
        lambda work, values: in_toto_statement(work, result, packed_summary(work), values),
    )


def _write_payload_and_return_evidence(
    pack_folder: Path, request: PackRequest, checked_result: _PackSource
) -> dict[str, Any]:
    result, check_request, rules, evidence, incidents = checked_result
    copied = [
        request.folder / name for name in sorted(contents.COPIED_RESULT_FILES) if (request.folder / name).is_file()
    ]
    (pack_folder / RESULT_FOLDER).mkdir(parents=True)
    for path in copied:
        shutil.copyfile(path, pack_folder / RESULT_FOLDER / path.name)
    reports = [
        report_format
        for report_format in REPORT_FORMATS.values()
        if (pack_folder / RESULT_FOLDER / report_format[0]).is_file()
    ]
    # A report in the folder may differ from the tables, or link to files that the pack leaves out.
    for name, render in reports:
        (pack_folder / RESULT_FOLDER / name).write_bytes(render(replace(result, folder=pack_folder / RESULT_FOLDER)))
    for name, files in evidence.items():
        if isinstance(files, dict):
            write_files(files, pack_folder / "data" / "findings" / name, pack_folder)
    for sheet, content in incidents.items():
        (pack_folder / sheet).parent.mkdir(exist_ok=True)
        (pack_folder / sheet).write_bytes(content)
    copy_rule_files(rules, pack_folder)
    selected = (
        check_request.mapping is not None and Path(check_request.mapping).is_file()
    )  # else a built-in mapping, or none
    mapping = (
        copy_into_new_folder(Path(str(check_request.mapping)), pack_folder / "data" / "mapping", pack_folder)
        if selected
        else None
    )
    inputs = _copy_inputs(pack_folder, check_request) if request.with_inputs else None
    packed_paths = {*copied, *(request.folder / Path(sheet).relative_to("data") for sheet in incidents)}
    left = [path for path in sorted(request.folder.rglob("*")) if path.is_file() and path not in packed_paths]
    evidence_file = {
        "evidence": contents.FORMAT_VERSION,
        **contents.evidence_values_of_result(pack_folder, result, check_request),
        "packed_with": contents.library_versions(),
        "mapping": mapping,
        "rules_dirs": copy_rules_dirs(check_request.rules_dirs, pack_folder),
        "inputs": inputs,
        **({"incidents": list(incidents)} if incidents else {}),
        "findings": contents.finding_entries(result.findings.to_pylist(), evidence),
        "left_out": [path.relative_to(request.folder).as_posix() for path in left],
    }
    (pack_folder / EVIDENCE_FILE).write_bytes((json.dumps(evidence_file, indent=2, ensure_ascii=False) + "\n").encode())
    return evidence_file


def _copy_inputs(pack_folder: Path, check_request: RunRequest) -> dict[str, Any]:
    """Copy logs and map into the pack; return their paths in the pack."""
    inputs = pack_folder / "data" / "inputs"
    paths: dict[str, Any] = {"traces": {}}
    for name, text in sorted(check_request.traces.items()):
        paths["traces"][name] = copy_into_new_folder(Path(text), inputs / "traces" / name, pack_folder)
    for option in ("map", "map_dir"):
        source = getattr(check_request, option)
        if source is not None:
            paths[option] = copy_into_new_folder(source, inputs / option, pack_folder)
    return paths
