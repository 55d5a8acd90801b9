"""Verifies an evidence pack: its files, its signature, its statement, and the result itself if log and map are available."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Final

import pyarrow.compute as pc

from drivelint import __version__
from drivelint.errors import DriveLintError, UsageError
from drivelint.pack import audits, bag, consistency, reproduction, sheets, signature, timestamp
from drivelint.pack.bag import Problem
from drivelint.pack.contents import RESULT_FOLDER, library_versions, path_inside_pack
from drivelint.pack.inputs import judged_drives, request_with_present_paths
from drivelint.pack.request import Verification
from drivelint.pack.statement import ENVELOPE_FILE, STATEMENT_FILE
from drivelint.pack.write import PUBLIC_KEY_FILE
from drivelint.phrases import plural
from drivelint.result import request as run_request
from drivelint.result.files import parquet_bytes
from drivelint.result.names import TABLE_OF_FILE

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    from drivelint.pack.consistency import PackContent
    from drivelint.pack.request import VerifyRequest
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

_OUTCOME_TEXTS: Final = {
    "PASSED": "every rule that applied was kept",
    "WARNED": "no rule was broken, but not everything was judged and kept with a margin",
    "FAILED": "the drives broke rules",
}

_PROBLEM_KINDS_OF_UNCHANGED_PACKS: Final = {"not signed", "nobody identified", "older pack"}
"""Kinds of problems that unchanged packs can have."""


def verify(request: VerifyRequest) -> Verification:
    """Verify a pack. Its files, signature and statement are checked before anything in it is used.

    Errors: `UsageError` if the folder is not a pack, or if a given key, log or map cannot be used.
    """
    key = _given_key(request)
    wrong = bag.problems_of_bag(
        request.folder, (ENVELOPE_FILE, PUBLIC_KEY_FILE, STATEMENT_FILE, timestamp.TIMESTAMP_FILE)
    )
    more, signed = _signature_problems_and_signer(request.folder, key)
    stamp = timestamp.check_pack_timestamp(request.folder, request.timestamp_root)
    wrong += [problem for problem in (*more, *stamp.problems, *_unmet_requirements(request)) if problem not in wrong]
    notes: list[str] = []
    judging, outcome = "not judged again", ""
    if not wrong and audits.is_pack_of_audit(request.folder):
        wrong, judging, outcome, notes = audits.verify_audit_pack(request)
    elif not wrong:
        wrong, stated = consistency.problems_and_content(request.folder)
        if stated is not None and not wrong:
            judging, wrong, notes = _judging_phrase_problems_and_notes(request, stated)
            outcome = stated.outcome
    elif any(problem.kind not in _PROBLEM_KINDS_OF_UNCHANGED_PACKS for problem in wrong):
        notes.append("not judged again, as the pack is not as it was written")
    n = sum(1 for path in request.folder.rglob("*") if path.is_file())
    # anyone can hash a changed pack again: only a known signature shows that it is unchanged
    date = bag.bagging_date(request.folder)
    signed = ", ".join(filter(None, (signed, stamp.description, "without a date" if date is None else f"dated {date}")))
    state = "consistent" if key is None else "untouched since it was signed"
    states = f"; it states that {_OUTCOME_TEXTS[outcome]} ({outcome})" if outcome else ""
    sentence = f"{request.folder}: {state}: {plural(n, 'file')}, {signed}, {judging}{states}"
    return Verification(wrong, sentence, [*stamp.notes, *notes])


def _unmet_requirements(request: VerifyRequest) -> list[Problem]:
    """Return why a consistent pack does not meet the request: its signer is unknown, or the pack is too old."""
    problems = []
    if request.require_signature and request.key is None:
        lack = (
            "the key in the pack does not identify its owner"
            if (request.folder / ENVELOPE_FILE).is_file()
            else "it is not signed"
        )
        problems.append(Problem("nobody identified", f"{lack}: use the signer's key with --key"))
    date = bag.bagging_date(request.folder)
    if request.not_before is not None and (date is None or date < request.not_before):
        age = "without a date" if date is None else f"dated {date}"
        problems.append(Problem("older pack", f"{age}, but --not-before {request.not_before} was required"))
    return problems


def _given_key(request: VerifyRequest) -> Ed25519PublicKey | None:
    if request.key is None:
        return None
    if request.key.resolve().is_relative_to(request.folder.resolve()):
        raise UsageError(
            f"--key {request.key}: comes with the pack, so it proves nothing: use a key from another source"
        )
    return signature.public_key(request.key)


def _signature_problems_and_signer(folder: Path, required_key: Ed25519PublicKey | None) -> tuple[list[Problem], str]:
    """Return the problems of the signature and of the unsigned files beside it, and a phrase about the signer."""
    if not (folder / ENVELOPE_FILE).is_file():
        is_due = required_key is not None or (folder / PUBLIC_KEY_FILE).is_file()
        stamped = (
            [Problem("file added", timestamp.TIMESTAMP_FILE)] if (folder / timestamp.TIMESTAMP_FILE).is_file() else []
        )
        return stamped + ([Problem("not signed", ENVELOPE_FILE)] if is_due else []), "not signed"
    if not (folder / PUBLIC_KEY_FILE).is_file():
        return [Problem("file removed", PUBLIC_KEY_FILE)], ""
    try:
        pack_key = signature.public_key(folder / PUBLIC_KEY_FILE)
        return _envelope_problems_and_signer(folder, pack_key, required_key)
    except UsageError:
        return [Problem("key not readable", PUBLIC_KEY_FILE)], ""
    except signature.EnvelopeError:
        return [Problem("signature not readable", ENVELOPE_FILE)], ""


def _envelope_problems_and_signer(
    folder: Path, pack_key: Ed25519PublicKey, required_key: Ed25519PublicKey | None
) -> tuple[list[Problem], str]:
    """Return the problems of a signed envelope, and a phrase about the signer. `pack_key`: the key in the pack."""
    content, signer = (folder / ENVELOPE_FILE).read_bytes(), pack_key if required_key is None else required_key
    by_own, by_signer = (signature.is_signed_by(content, key) for key in (pack_key, signer))
    if not (by_own or by_signer):
        return [Problem("signature wrong", ENVELOPE_FILE)], ""
    has, due = (signature.key_id(key)[:16] for key in (pack_key, signer))
    if not by_signer:
        return [Problem("another key", f"signed by {has}, not by {due}, which was given")], ""
    wrong = [] if by_own else [Problem("another key", f"{PUBLIC_KEY_FILE} is not the key that signed")]
    if not signature.is_canonical_envelope(content, signer):
        wrong.append(Problem("text beside the signed content", ENVELOPE_FILE))
    if (folder / PUBLIC_KEY_FILE).read_bytes() != signature.public_key_pem(pack_key):
        wrong.append(Problem("text beside the key", PUBLIC_KEY_FILE))
    if (folder / STATEMENT_FILE).is_file():
        wrong.append(Problem("file added", STATEMENT_FILE))
    if required_key is None:
        return wrong, f"signed by the key in the pack ({due}; only --key identifies its owner)"
    return wrong, f"signed by the key that was given ({due})"


def _judging_phrase_problems_and_notes(
    request: VerifyRequest, stated: PackContent
) -> tuple[str, list[Problem], list[str]]:
    """Judge the drives again if their logs are available. Return the result as a phrase, the problems, and notes on what was not
    examined."""
    result, evidence = stated.result, stated.evidence
    notes = _notes_on_unexamined(evidence, result)
    try:
        check_request = _request_with_pack_paths(request.folder, evidence)
        if evidence["inputs"] is None and not request.traces:
            wrong, phrase = consistency.check_sql_of_findings(request.folder, result, check_request)
            notes.insert(0, f"the logs are not in the pack: judged again only with --trace and --map; {phrase}")
            if sheets.sheet_paths_in_evidence(evidence):
                notes.append("its incident sheets are as the pack says: they are written again only with the logs")
            return "not judged again", wrong, notes
    except consistency.READ_ERRORS as error:
        return "", [Problem("evidence.json not readable", str(error))], notes
    try:
        check_request = request_with_present_paths(
            check_request, result.drives.to_pylist(), request.traces, request.map
        )
    except UsageError as error:
        if request.traces or request.map is not None:
            raise
        return "", [Problem("inputs do not match the result", str(error))], notes
    if sheets.sheet_paths_in_evidence(evidence) and evidence["packed_with"] != library_versions():
        notes.append("packed with other versions of libraries: its incident sheets are not written again")
    judging, wrong = _judge_result_again(request.folder, stated, check_request)
    return judging, wrong, notes


def _notes_on_unexamined(evidence: dict[str, Any], result: Result) -> list[str]:
    """Return notes on content that cannot be compared with the logs, on other versions, and on rules that are not drivelint's own."""
    notes = []
    if (version := consistency.packing_version(evidence)) != __version__:
        notes.append(f"packed by drivelint {version}, and this is {__version__}: its reports are not written again")
    if (version := evidence["tool"]["version"]) != __version__:
        notes.append(f"judged by drivelint {version}, and this is {__version__}")
    if evidence["rules_dirs"]:
        notes.append(f"rules and profiles in {', '.join(evidence['rules_dirs'])} are not drivelint's: read them")
    if evidence["not_judged"]:
        notes.append(f"not judged when it was checked, nor now: {', '.join(evidence['not_judged'])}")
    if sheets.has_sheet_as_pdf(evidence):
        notes.append("an incident sheet as PDF is as the pack says: the page beside it is what is written again")
    if result.gate is not None:
        notes.append("baseline and waivers are as the pack says: they are not checked again")
    return notes


def _request_with_pack_paths(folder: Path, evidence: dict[str, Any]) -> RunRequest:
    """Return the check with the paths of the files in the pack. Errors: `ValueError` for a path outside the pack."""

    inputs = evidence["inputs"]
    check_request = run_request.load(folder / RESULT_FOLDER)
    mapping = (
        check_request.mapping if evidence["mapping"] is None else str(path_inside_pack(folder, evidence["mapping"]))
    )
    check_request = replace(
        check_request,
        mapping=mapping,
        rules_dirs=tuple(path_inside_pack(folder, path) for path in evidence["rules_dirs"]),
    )
    if inputs is not None:
        map_, map_dir = (
            path_inside_pack(folder, inputs[name]) if name in inputs else None for name in ("map", "map_dir")
        )
        traces = {name: str(path_inside_pack(folder, path)) for name, path in inputs["traces"].items()}
        check_request = replace(check_request, traces=traces, map=map_, map_dir=map_dir)
    return check_request


def _judge_result_again(folder: Path, stated: PackContent, check_request: RunRequest) -> tuple[str, list[Problem]]:
    """Judge the drives again; return the result as a phrase, and the files that differ."""
    result = stated.result
    margins = (folder / RESULT_FOLDER / "margins.parquet").is_file()
    other_libraries = stated.evidence["packed_with"] != library_versions()
    try:
        with TemporaryDirectory(prefix="drivelint-") as work:
            fresh = reproduction.check_again(result, check_request, Path(work) if margins else None)
            files = {
                f"{RESULT_FOLDER}/{name}.parquet": parquet_bytes(_table_of_judged_drives(fresh, name), table)
                for name, table in TABLE_OF_FILE.items()
            }
            if fresh.margins_file is not None:
                files[f"{RESULT_FOLDER}/margins.parquet"] = fresh.margins_file.read_bytes()
        for name, contents in reproduction.evidence_of_findings(result, check_request).items():
            if isinstance(contents, dict):
                files |= {f"data/findings/{name}/{file}": content for file, content in contents.items()}
        if not other_libraries:
            files |= sheets.pages_written_again(folder / RESULT_FOLDER, stated.evidence, check_request)
    except DriveLintError as error:
        return "", [Problem("result not reproduced", str(error))]
    whole = result.drives.num_rows == fresh.drives.num_rows
    packed = {
        f"{RESULT_FOLDER}/{name}.parquet": parquet_bytes(_table_of_judged_drives(result, name), table)
        for name, table in ({} if whole else TABLE_OF_FILE).items()
    }
    wrong, other_bytes = reproduction.file_problems_and_whether_bytes_differ(
        folder, files, packed, other_libraries=other_libraries
    )
    extra = {
        path.relative_to(folder).as_posix() for path in (folder / "data" / "findings").rglob("*") if path.is_file()
    }
    wrong += [Problem("result not reproduced", f"{path}: no finding gives it") for path in sorted(extra - files.keys())]
    n = plural(len(judged_drives(result.drives.to_pylist())), "drive")
    same = "the same rows, written by another version of a library" if other_bytes else "the same bytes"
    return f"{n} judged again: {same}", wrong


def _table_of_judged_drives(result: Result, name: str) -> Any:
    """Return a table of a result, without the drives that could not be judged."""
    rows = getattr(result, name)
    return rows.filter(pc.equal(rows["status"], "judged")) if name == "drives" else rows
