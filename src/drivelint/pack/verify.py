"""Verifies an evidence pack: its files, its signature, what it states, and the result itself where log and map are there."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pyarrow.compute as pc

from drivelint.errors import DriveLintError, UsageError
from drivelint.pack import again, bag, signature
from drivelint.pack.bag import Problem
from drivelint.pack.contents import EVIDENCE, RESULT, SAID_OF_FINDINGS, facts, summary_of
from drivelint.pack.inputs import judged, located
from drivelint.pack.statement import ENVELOPE, FILE, differences, statement
from drivelint.pack.write import PUBLIC_KEY
from drivelint.phrases import plural
from drivelint.report import summary
from drivelint.result import request as run_request
from drivelint.result.files import parquet_bytes
from drivelint.result.load import load_result
from drivelint.result.schemas import TABLE_OF_FILE

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest


@dataclass(frozen=True)
class VerifyRequest:
    """What `verify` is asked: a pack, the key that it must be signed with, and where log and map are if they are not in it."""

    folder: Path
    key: Path | None = None
    traces: tuple[Path, ...] = ()
    map: Path | None = None


@dataclass(frozen=True)
class Verification:
    """What is wrong with a pack, in words if nothing is, and what was not looked at."""

    problems: list[Problem]
    sentence: str
    notes: list[str]


def verify(request: VerifyRequest) -> Verification:
    """Verify a pack. What its files, signature and statement say is looked at before anything in it is used.

    Errors: `UsageError` where it is no pack, or for a key, log or map that was given and cannot be used.
    """
    key = None if request.key is None else signature.public_key(request.key)
    wrong = bag.problems(request.folder)
    more, signed = _of_signature(request.folder, key)
    wrong += [problem for problem in more if problem not in wrong]
    notes: list[str] = []
    judging = "not judged again"
    if not wrong:
        stated, result, evidence = _of_statement(request.folder)
        wrong += stated
        if result is not None and not wrong:
            asked = _inputs(request, result, evidence)
            if asked is None:
                notes.append("the logs are not in the pack: judged again only with --trace and --map")
            else:
                judging, differing = _of_result(request.folder, result, asked)
                wrong += differing
    elif any(problem.kind != "not signed" for problem in wrong):
        notes.append("not judged again, as the pack is not as it was written")
    n = sum(1 for path in request.folder.rglob("*") if path.is_file())
    # whoever changes a pack can hash it anew: only a signature that is known says that nobody did
    state = "consistent" if key is None else "untouched since it was signed"
    sentence = f"{request.folder}: {state}: {plural(n, 'file')}, {signed}, {judging}"
    return Verification(wrong, sentence, notes)


def _of_signature(folder: Path, key: Ed25519PublicKey | None) -> tuple[list[Problem], str]:
    """Return what is wrong with the signature, and who signed in words."""
    file, embedded = folder / ENVELOPE, folder / PUBLIC_KEY
    if not file.is_file():
        return ([Problem("not signed", ENVELOPE)] if key is not None or embedded.is_file() else []), "not signed"
    try:
        own = signature.public_key(embedded) if embedded.is_file() else None
        good = {signature.key_id(k): signature.is_signed_by(file.read_bytes(), k) for k in (key, own) if k is not None}
    except (signature.EnvelopeError, UsageError) as error:
        of_key = isinstance(error, UsageError)
        return [Problem(f"{'key' if of_key else 'signature'} not readable", PUBLIC_KEY if of_key else ENVELOPE)], ""
    wanted, has = (None if k is None else signature.key_id(k) for k in (key, own))
    if (wanted or has) is None or not any(good.values()):
        return [Problem("signature wrong", ENVELOPE)], ""
    if wanted is None:
        return [], f"signed by the key in the pack ({_short(has)}; only --key tells whose that is)"
    if not good[wanted]:
        return [Problem("another key", f"signed by {_short(has)}, not by {_short(wanted)}, which was given")], ""
    return [], f"signed by the key that was given ({_short(wanted)})"


def _short(key_id: str | None) -> str:
    return (key_id or "")[:16]


def _of_statement(folder: Path) -> tuple[list[Problem], Result | None, dict[str, Any]]:
    """Return what is wrong with the statement, and the result and the list of what is in the pack."""
    name = ENVELOPE if (folder / ENVELOPE).is_file() else FILE
    try:
        evidence: dict[str, Any] = json.loads((folder / EVIDENCE).read_text("utf-8"))
        result = load_result(folder / RESULT)
        wrong = _of_evidence(folder, result, evidence)
        due = statement(folder, result, summary_of(folder), evidence)
    except (DriveLintError, OSError, ValueError, KeyError, TypeError) as error:
        return [Problem("result not readable", str(error))], None, {}
    if not (folder / name).is_file():
        return [Problem("statement missing", FILE)], result, evidence
    content = (folder / name).read_bytes()
    said = signature.payload_of(content) if name == ENVELOPE else content
    return differences(said, due) + wrong, result, evidence


def _of_evidence(folder: Path, result: Result, evidence: dict[str, Any]) -> list[Problem]:
    """Return in what `evidence.json` does not say what the result and the rules in the pack say."""
    due = facts(folder, result, run_request.load(folder / RESULT))
    due["findings"] = result.findings.select(SAID_OF_FINDINGS).to_pylist()
    told = {**evidence, "findings": [{key: row.get(key) for key in SAID_OF_FINDINGS} for row in evidence["findings"]]}
    due["rule versions"] = result.rules["rule_version"].to_pylist()
    told["rule versions"] = [rule["rule_version"] for rule in due["rules"]]
    wrong = [
        Problem("evidence.json does not fit the result", key) for key, value in due.items() if told.get(key) != value
    ]
    said, counted = summary_of(folder), json.loads(summary.render(result))
    keys = sorted(key for key in counted if key != "tool" and said.get(key) != counted[key])
    return wrong + [Problem("summary.json does not fit the tables", key) for key in keys]


def _inputs(request: VerifyRequest, result: Result, evidence: dict[str, Any]) -> RunRequest | None:
    """Return the check with the paths at which its logs are: in the pack or given; None: neither.

    Errors: `UsageError` for a path that leads out of the pack, and as those of `located`.
    """
    inside = evidence["inputs"]
    if inside is None and not request.traces:
        return None

    def place(path: str) -> Path:
        found = request.folder / path
        if not found.resolve().is_relative_to(request.folder.resolve()):
            raise UsageError(f"{EVIDENCE} leads out of the pack: {path}")
        return found

    asked = run_request.load(request.folder / RESULT)
    mapping = asked.mapping if evidence["mapping"] is None else str(place(evidence["mapping"]))
    asked = replace(asked, mapping=mapping, rules_dirs=tuple(place(path) for path in evidence["rules_dirs"]))
    if inside is not None:
        map_, map_dir = (place(inside[what]) if what in inside else None for what in ("map", "map_dir"))
        traces = {name: str(place(path)) for name, path in inside["traces"].items()}
        asked = replace(asked, traces=traces, map=map_, map_dir=map_dir)
    return located(asked, result.drives.to_pylist(), request.traces, request.map)


def _of_result(folder: Path, result: Result, asked: RunRequest) -> tuple[str, list[Problem]]:
    """Judge the drives again; return in words what came out, and the files that came out otherwise."""
    margins = (folder / RESULT / "margins.parquet").is_file()
    try:
        with TemporaryDirectory(prefix="drivelint-") as work:
            fresh = again.check_again(result, asked, Path(work) if margins else None)
            files = {
                f"{RESULT}/{name}.parquet": parquet_bytes(_judged_rows(fresh, name), table)
                for name, table in TABLE_OF_FILE.items()
            }
            if fresh.margins_file is not None:
                files[f"{RESULT}/margins.parquet"] = fresh.margins_file.read_bytes()
        for name, contents in again.finding_evidence(result, asked).items():
            if isinstance(contents, dict):
                files |= {f"data/findings/{name}/{file}": content for file, content in contents.items()}
    except DriveLintError as error:
        return "", [Problem("result not reproduced", str(error))]
    whole = result.drives.num_rows == fresh.drives.num_rows
    held = {f"{RESULT}/{name}.parquet": name for name in TABLE_OF_FILE}
    other_bytes, wrong = False, []
    for path, content in files.items():
        if not (folder / path).is_file():
            wrong.append(Problem("result not reproduced", f"{path}: is not in the pack"))
            continue
        there = (folder / path).read_bytes()
        if path in held and not whole:
            there = parquet_bytes(_judged_rows(result, held[path]), TABLE_OF_FILE[held[path]])
        if there != content:
            other_bytes = True
            if not path.endswith(".parquet") or not again.same_rows(there, content):
                wrong.append(Problem("result not reproduced", path))
    extra = {
        path.relative_to(folder).as_posix() for path in (folder / "data" / "findings").rglob("*") if path.is_file()
    }
    wrong += [Problem("result not reproduced", f"{path}: no finding gives it") for path in sorted(extra - files.keys())]
    n = plural(len(judged(result.drives.to_pylist())), "drive")
    same = "the same rows, written by another version of a library" if other_bytes else "the same bytes"
    return f"{n} judged again: {same}", wrong


def _judged_rows(result: Result, name: str) -> Any:
    """Return a table of a result without the drives that were not judged: nobody can judge them again."""
    rows = getattr(result, name)
    return rows.filter(pc.equal(rows["status"], "judged")) if name == "drives" else rows
