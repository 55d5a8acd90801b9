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
from drivelint.pack import again, audits, bag, contents, sheets, signature, timestamp
from drivelint.pack.contents import EVIDENCE, RESULT, summary_of
from drivelint.pack.copying import copy, copy_rules, copy_rules_dirs, write_files
from drivelint.pack.inputs import located
from drivelint.pack.request import MOST_FINDINGS, PackFunctions
from drivelint.pack.statement import ENVELOPE, FILE, statement
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result import request as run_request
from drivelint.result.load import load_result
from drivelint.result.publishing import OutputError

if TYPE_CHECKING:
    from drivelint.catalogue import Rule
    from drivelint.pack.request import PackRequest
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

PUBLIC_KEY: Final = "public-key.pem"


class _PackSource(NamedTuple):
    """The content for the pack of a check. `incidents`: path in the pack -> content of the incident sheets."""

    result: Result
    check_request: RunRequest
    rules: list[Rule]
    evidence: again.Evidence
    incidents: dict[str, bytes]


def write_pack(request: PackRequest) -> dict[str, Any]:
    """Write the pack and return the content of its `evidence.json`. Nothing exists at `out` until the pack is complete.

    Errors: `UsageError` for a result, log, map, rule or key that is missing or has changed, and if `out` exists without `overwrite`;
    `OutputError`.
    """
    key = ready(request)
    is_audit = audits.is_audit(request.folder)
    if not is_audit and request.findings != MOST_FINDINGS:
        raise UsageError("--findings is of an audit: the pack of a check has all of its findings")
    content = audits.content(request) if is_audit else _content(request)
    try:
        request.out.parent.mkdir(parents=True, exist_ok=True)
        work = Path(mkdtemp(prefix=".drivelint.", dir=request.out.parent))
        try:
            told = content.payload(work)
            info = {"Bag-Software-Agent": f"drivelint {__version__}"}
            bag.begin(work, info if request.date is None else {"Bagging-Date": request.date, **info})
            said = content.statement(work, told)
            if key is None:
                (work / FILE).write_bytes(said)
            else:
                sealed = signature.envelope(said, key)
                (work / ENVELOPE).write_bytes(sealed)
                if request.timestamp is not None:
                    (work / timestamp.FILE).write_bytes(timestamp.read(request.timestamp, sealed))
                (work / PUBLIC_KEY).write_bytes(signature.public_pem(key.public_key()))
            bag.finish(work)
            work.chmod(0o755)
            if request.out.exists():
                shutil.rmtree(request.out)
            work.rename(request.out)
        finally:
            shutil.rmtree(work, ignore_errors=True)
    except OSError as error:
        raise OutputError(f"{request.out}: cannot write the pack: {error.strerror or error}") from error
    return told


def ready(request: PackRequest) -> signature.SigningKey | None:
    """Return the key that signs a pack; None: the pack is not signed. Errors: `UsageError` for an invalid request, or if `out` exists
    without `overwrite`."""
    if (url := url_of_path(request.folder)) is not None:
        raise UsageError(f"{url}: is in an object store: copy it into a folder of this machine and pack that")
    if (url := url_of_path(request.out)) is not None:
        raise UsageError(f"{url}: a pack is a folder of this machine: write it here and copy it there")
    if request.timestamp is not None and request.key is None:
        raise UsageError("--timestamp is for a signed statement: use --sign with the key, too")
    key = None if request.key is None else signature.signing_key(request.key)
    _free(request.out, overwrite=request.overwrite)
    if request.out.resolve().is_relative_to(request.folder.resolve()):
        raise UsageError(f"{request.out}: lies in the result that is packed: choose a folder beside it")
    return key


def _free(out: Path, *, overwrite: bool) -> None:
    if not out.exists() or (out.is_dir() and not any(out.iterdir())):
        return
    if not out.is_dir() or not (out / bag.DECLARATION).is_file() or not (out / EVIDENCE).is_file():
        raise UsageError(f"{out}: is there and is no evidence pack: choose another folder")
    if not overwrite:
        raise UsageError(f"{out}: has a pack: choose another folder, or replace it with drivelint pack --overwrite")


def _content(request: PackRequest) -> PackFunctions:
    """Return the functions that pack the result of a check. The logs are judged again here, before anything is written."""
    result = load_result(request.folder)
    check_request = run_request.load(request.folder)
    if check_request.manifest_options:
        raise UsageError(
            f"{request.folder}: its logs have options of their own, by a manifest: audit that, and pack the audit"
        )
    check_request = located(check_request, result.drives.to_pylist(), request.traces, request.map)
    rules, evidence = again.rules_of(result, check_request), again.finding_evidence(result, check_request)
    checked_result = _PackSource(
        result, check_request, rules, evidence, sheets.of_result(request.folder, result, check_request)
    )
    return PackFunctions(
        lambda work: _payload(work, request, checked_result),
        lambda work, told: statement(work, result, summary_of(work), told),
    )


def _payload(work: Path, request: PackRequest, checked_result: _PackSource) -> dict[str, Any]:
    result, check_request, rules, evidence, incidents = checked_result
    copied = [request.folder / name for name in sorted(contents.OUTPUTS) if (request.folder / name).is_file()]
    (work / RESULT).mkdir(parents=True)
    for path in copied:
        shutil.copyfile(path, work / RESULT / path.name)
    reports = [each for each in REPORT_FORMATS.values() if (work / RESULT / each[0]).is_file()]
    # A report in the folder may differ from the tables, or link to files that the pack leaves out.
    for name, render in reports:
        (work / RESULT / name).write_bytes(render(replace(result, folder=work / RESULT)))
    for name, files in evidence.items():
        if isinstance(files, dict):
            write_files(files, work / "data" / "findings" / name, work)
    for sheet, content in incidents.items():
        (work / sheet).parent.mkdir(exist_ok=True)
        (work / sheet).write_bytes(content)
    copy_rules(rules, work)
    named = (
        check_request.mapping is not None and Path(check_request.mapping).is_file()
    )  # else a built-in mapping, or none
    mapping = copy(Path(str(check_request.mapping)), work / "data" / "mapping", work) if named else None
    inputs = _copied_inputs(work, check_request) if request.with_inputs else None
    taken = {*copied, *(request.folder / Path(sheet).relative_to("data") for sheet in incidents)}
    left = [path for path in sorted(request.folder.rglob("*")) if path.is_file() and path not in taken]
    told = {
        "evidence": contents.FORM,
        **contents.facts(work, result, check_request),
        "packed_with": contents.library_versions(),
        "mapping": mapping,
        "rules_dirs": copy_rules_dirs(check_request.rules_dirs, work),
        "inputs": inputs,
        **({"incidents": list(incidents)} if incidents else {}),
        "findings": contents.findings(result.findings.to_pylist(), evidence),
        "left_out": [path.relative_to(request.folder).as_posix() for path in left],
    }
    (work / EVIDENCE).write_bytes((json.dumps(told, indent=2, ensure_ascii=False) + "\n").encode())
    return told


def _copied_inputs(work: Path, check_request: RunRequest) -> dict[str, Any]:
    """Copy logs and map into the pack; return their paths in the pack."""
    inputs = work / "data" / "inputs"
    told: dict[str, Any] = {"traces": {}}
    for name, text in sorted(check_request.traces.items()):
        told["traces"][name] = copy(Path(text), inputs / "traces" / name, work)
    for what in ("map", "map_dir"):
        given = getattr(check_request, what)
        if given is not None:
            told[what] = copy(given, inputs / what, work)
    return told
