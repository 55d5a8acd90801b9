"""Writes an evidence pack: the result, the rules, what gives each finding again, and by choice the logs and the map."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from drivelint import __version__
from drivelint.errors import UsageError
from drivelint.pack import again, bag, contents, signature, timestamp
from drivelint.pack.contents import EVIDENCE, RESULT, summary_of
from drivelint.pack.inputs import located
from drivelint.pack.statement import ENVELOPE, FILE, statement
from drivelint.report.outputs import REPORT_FORMATS
from drivelint.result import request as run_request
from drivelint.result.files import OutputError
from drivelint.result.load import load_result

if TYPE_CHECKING:
    from drivelint.catalogue import Rule
    from drivelint.result.model import Result
    from drivelint.result.request import RunRequest

PUBLIC_KEY: Final = "public-key.pem"


class _Checked(NamedTuple):
    """A result with its check, rules and evidence."""

    result: Result
    asked: RunRequest
    rules: list[Rule]
    found: again.Evidence


@dataclass(frozen=True)
class PackRequest:
    """What `pack` is asked: a result folder, where the pack goes, what goes into it, who signs it, its time stamp."""

    folder: Path
    out: Path
    key: Path | None = None
    with_inputs: bool = False
    traces: tuple[Path, ...] = ()
    map: Path | None = None
    date: str | None = None
    timestamp: Path | None = None
    overwrite: bool = False


def write_pack(request: PackRequest) -> dict[str, Any]:
    """Write the pack as one: until it is whole, nothing is at `out`. Return what its `evidence.json` says.

    Errors: `UsageError` for a result, log, map, rule or key that is not there or is another one, and where `out` is taken; `OutputError`.
    """
    if request.timestamp is not None and request.key is None:
        raise UsageError("--timestamp is of a signed statement: give the key, too, with --sign")
    key = None if request.key is None else signature.signing_key(request.key)
    _free(request)
    result = load_result(request.folder)
    asked = run_request.load(request.folder)
    asked = located(asked, result.drives.to_pylist(), request.traces, request.map)
    checked = _Checked(result, asked, again.rules_of(result, asked), again.finding_evidence(result, asked))
    try:
        request.out.parent.mkdir(parents=True, exist_ok=True)
        work = Path(mkdtemp(prefix=".drivelint.", dir=request.out.parent))
        try:
            told = _payload(work, request, checked)
            info = {"Bag-Software-Agent": f"drivelint {__version__}"}
            bag.begin(work, info if request.date is None else {"Bagging-Date": request.date, **info})
            said = statement(work, result, summary_of(work), told)
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


def _free(request: PackRequest) -> None:
    out = request.out
    if not out.exists() or (out.is_dir() and not any(out.iterdir())):
        return
    if not out.is_dir() or not (out / bag.DECLARATION).is_file() or not (out / EVIDENCE).is_file():
        raise UsageError(f"--out {out}: is there and is no evidence pack: choose another folder")
    if not request.overwrite:
        raise UsageError(f"--out {out}: has a pack: choose another folder, or replace it with --overwrite")


def _payload(work: Path, request: PackRequest, checked: _Checked) -> dict[str, Any]:
    result, asked, rules, found = checked
    copied = [request.folder / name for name in sorted(contents.OUTPUTS) if (request.folder / name).is_file()]
    (work / RESULT).mkdir(parents=True)
    for path in copied:
        shutil.copyfile(path, work / RESULT / path.name)
    reports = [each for each in REPORT_FORMATS.values() if (work / RESULT / each[0]).is_file()]
    # A report of the folder may differ from the tables, or link files that the pack leaves out.
    for name, render in reports:
        (work / RESULT / name).write_bytes(render(replace(result, folder=work / RESULT)))
    for name, files in found.items():
        if isinstance(files, dict):
            place = _made(work / "data" / "findings" / name, work)
            for file, content in files.items():
                (place / file).write_bytes(content)
    for rule in rules:
        place = work / "data" / "rules" / rule.pack
        place.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(rule.path, place / rule.path.name)
    dirs = work / "data" / "rules_dirs"
    folders = [_copy(folder.resolve(), dirs / str(no), work) for no, folder in enumerate(asked.rules_dirs)]
    named = asked.mapping is not None and Path(asked.mapping).is_file()  # else it is a shipped one, or none
    mapping = _copy(Path(str(asked.mapping)), work / "data" / "mapping", work) if named else None
    inputs = _copied_inputs(work, asked) if request.with_inputs else None
    left = [path for path in sorted(request.folder.rglob("*")) if path.is_file() and path not in copied]
    told = {
        "evidence": contents.FORM,
        **contents.facts(work, result, asked),
        "packed_with": contents.library_versions(),
        "mapping": mapping,
        "rules_dirs": folders,
        "inputs": inputs,
        "findings": contents.findings(result, found),
        "left_out": [path.relative_to(request.folder).as_posix() for path in left],
    }
    (work / EVIDENCE).write_bytes((json.dumps(told, indent=2, ensure_ascii=False) + "\n").encode())
    return told


def _copied_inputs(work: Path, asked: RunRequest) -> dict[str, Any]:
    """Copy logs and map into the pack; return where each is."""
    inputs = work / "data" / "inputs"
    told: dict[str, Any] = {"traces": {}}
    for name, text in sorted(asked.traces.items()):
        told["traces"][name] = _copy(Path(text), inputs / "traces" / name, work)
    for what in ("map", "map_dir"):
        given = getattr(asked, what)
        if given is not None:
            told[what] = _copy(given, inputs / what, work)
    return told


def _made(place: Path, work: Path) -> Path:
    """Make a folder in the pack. Its name may be an id of a result that somebody else made."""
    if not place.resolve().is_relative_to(work.resolve() / "data") or place.is_dir():
        raise UsageError(f"{place.name}: no id of a finding or a drive: check the drives again")
    place.mkdir(parents=True)
    return place


def _copy(source: Path, place: Path, work: Path) -> str:
    target = _made(place, work) / source.name
    if source.is_dir():
        shutil.copytree(source, target)
    else:
        shutil.copyfile(source, target)
    return target.relative_to(work).as_posix()
