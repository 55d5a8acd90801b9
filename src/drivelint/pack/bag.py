"""A folder in BagIt format (RFC 8493): writes its manifests, and finds the files that do not match them."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

DATA: Final = "data"
DECLARATION: Final = "bagit.txt"
INFO: Final = "bag-info.txt"
MANIFEST: Final = "manifest-sha256.txt"
TAG_MANIFEST: Final = "tagmanifest-sha256.txt"
_DECLARATION_BYTES: Final = b"BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n"
_MANIFEST_LINE_PATTERN: Final = re.compile(r"([0-9a-f]{64})  ([^\s].*)")
DESCRIPTION: Final = """\
A result of drivelint, and what it was judged from.
  Was a file changed? sha256sum -c manifest-sha256.txt tagmanifest-sha256.txt
  Who signed it, and does the log give this result? drivelint verify PACK --key KEY
  KEY is the public key of the signer: from the signer, not from this folder.
  No check shows that the log itself is true.
"""
"""The description of a pack for somebody who has only the pack: a tag whose further lines are indented."""
_BAG_INFO_PATTERN: Final = re.compile(
    rf"(?:External-Description: {re.escape(DESCRIPTION)})?"
    r"(?:Bagging-Date: (\d{4}-\d\d-\d\d)\n)?Bag-Software-Agent: drivelint [^\s]+\nPayload-Oxum: (\d+\.\d+)\n"
)
_REFUSED_FILE_NAME_CHARACTER: Final = re.compile(r"[\r\n%\\\ud800-\udfff]")
"""A path with such a character cannot be packed."""


CHANGED_SINCE_STATEMENT: Final = "file changed since the statement about it"
"""The kind of problem of a file whose hash differs from that in the statement."""
_EXPLANATION_BY_KIND: Final = {
    "file changed": "its bytes are not those that the manifest lists",
    "manifest changed": f"its bytes are not those that {TAG_MANIFEST} lists",
    "file added": "nothing in the pack lists it",
    "file removed": "it is listed, and not there",
}
"""Kind of problem -> the sentence that states what is wrong with the file."""


class Problem(NamedTuple):
    """A problem of a pack: its kind and its subject, such as a file."""

    kind: str
    subject: str


def explanation_text(problem: Problem) -> str:
    """Return in words what is wrong with a file that is a problem, after a colon; '' for problems that their kinds explain."""
    if problem.kind == CHANGED_SINCE_STATEMENT:
        explanation = "its bytes are not those that the statement lists"
        if problem.subject == MANIFEST:
            explanation += f", so a file in {DATA}/ was changed, added or removed, and the manifest was written again"
    else:
        explanation = _EXPLANATION_BY_KIND.get(problem.kind, "")
    return f": {explanation}" if explanation else ""


def sha256_of(path: Path) -> str:
    """Return the hash of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def write_info_and_manifest(folder: Path, info: Mapping[str, str]) -> None:
    """Write the declaration, the information about the bag, and the manifest of its complete payload.

    Errors: `UsageError` for a file name that `sha256sum -c` cannot read.
    """
    payload = [path for path in sorted((folder / DATA).rglob("*")) if path.is_file()]
    size = sum(path.stat().st_size for path in payload)
    values = {**info, "Payload-Oxum": f"{size}.{len(payload)}"}
    (folder / DECLARATION).write_bytes(_DECLARATION_BYTES)
    (folder / INFO).write_text("".join(f"{name}: {value}\n" for name, value in values.items()), "utf-8", newline="\n")
    _write_manifest(folder, MANIFEST, payload)


def write_tag_manifest(folder: Path) -> None:
    """Write the manifest of the tag files: all files outside the payload."""
    _write_manifest(folder, TAG_MANIFEST, [folder / name for name in sorted(_tag_file_names(folder) - {TAG_MANIFEST})])


def _write_manifest(folder: Path, manifest_name: str, files: Iterable[Path]) -> None:
    lines = []
    for path in files:
        inner = path.relative_to(folder).as_posix()
        if _REFUSED_FILE_NAME_CHARACTER.search(inner):
            raise UsageError(f"{inner}: sha256sum does not find a file of such a name: rename it")
        lines.append(f"{sha256_of(path)}  {inner}\n")
    (folder / manifest_name).write_text("".join(lines), "utf-8", newline="\n")


def problems_of_bag(folder: Path, allowed_tag_files: Collection[str]) -> list[Problem]:
    """Return the differences from the manifests, sorted by file: changed, removed and added files, and changed manifests.

    `allowed_tag_files`: the tag files that a pack may have besides those of BagIt. Any other tag file counts as added, because no signature
    covers it. Links are not followed. Errors: `UsageError` if the folder is not a bag.
    """
    if not (folder / DECLARATION).is_file() and not (folder / MANIFEST).is_file():
        raise UsageError(f"{folder}: no evidence pack: name the folder that drivelint pack --out wrote")
    problems: list[Problem] = []
    files: set[str] = set()
    for path in folder.rglob("*"):
        name = path.relative_to(folder).as_posix()
        if path.is_symlink() or not (path.is_file() or path.is_dir()):
            problems.append(Problem("link" if path.is_symlink() else "not a file", name))
        elif path.is_file():
            files.add(name)
    payload = {name for name in files if name.startswith(f"{DATA}/")}
    tag_files = files - payload - {TAG_MANIFEST}
    problems += [Problem("file added", name) for name in tag_files - {DECLARATION, INFO, MANIFEST, *allowed_tag_files}]
    if DECLARATION in files and (folder / DECLARATION).read_bytes() != _DECLARATION_BYTES:
        problems.append(Problem("file changed", DECLARATION))
    for manifest, names in ((TAG_MANIFEST, tag_files), (MANIFEST, payload)):
        if manifest not in files:
            problems.append(Problem("file removed", manifest))
            continue
        listed, wrong = _read_manifest(folder / manifest, is_of_payload=manifest == MANIFEST)
        problems += wrong
        problems += [Problem("file removed", name) for name in listed.keys() - names]
        problems += [Problem("file added", name) for name in names - listed.keys()]
        for name in sorted(listed.keys() & names):
            if sha256_of(folder / name) != listed[name]:
                problems.append(Problem("manifest changed" if name == MANIFEST else "file changed", name))
    problems += [Problem("file removed", name) for name in (DECLARATION, INFO) if name not in files]
    problems += _problems_of_info(folder, payload) if INFO in files else []
    return sorted(set(problems), key=lambda problem: (problem.subject, problem.kind))


def bagging_date(folder: Path) -> str | None:
    """Return the day in `bag-info.txt`, such as 2026-11-26; None: the file has no day, or cannot be read."""
    path = folder / INFO
    match = _BAG_INFO_PATTERN.fullmatch(path.read_text("utf-8", "replace")) if path.is_file() else None
    return match[1] if match else None


def _problems_of_info(folder: Path, payload: Iterable[str]) -> list[Problem]:
    """Return the differences between `bag-info.txt` and the text that `write_info_and_manifest` writes for this payload."""
    text = (folder / INFO).read_text("utf-8", "replace")
    match = _BAG_INFO_PATTERN.fullmatch(text)
    if match is None:
        return [Problem("bag-info.txt not readable", INFO)]
    sizes = [(folder / name).stat().st_size for name in payload]
    due = f"{sum(sizes)}.{len(sizes)}"
    return [] if match[2] == due else [Problem("Payload-Oxum wrong", f"{INFO}: {match[2]}, and it is {due}")]


def _read_manifest(path: Path, *, is_of_payload: bool) -> tuple[dict[str, str], list[Problem]]:
    """Return file -> hash of a manifest, and its invalid lines as problems."""
    listed: dict[str, str] = {}
    wrong = []
    # not splitlines, which also splits at other characters that a file name may contain
    lines = path.read_text("utf-8", "replace").removesuffix("\n").split("\n")
    for no, line in enumerate(lines, 1):
        match = _MANIFEST_LINE_PATTERN.fullmatch(line)
        name = match[2] if match else ""
        inner = PurePosixPath(name)
        if match is None:
            wrong.append(Problem("manifest not readable", f"{path.name} line {no}"))
        elif name in listed:
            wrong.append(Problem("manifest names a file twice", f"{path.name}: {name}"))
        elif inner.is_absolute() or ".." in inner.parts or (inner.parts[:1] == (DATA,)) is not is_of_payload:
            wrong.append(Problem("manifest names a file outside", f"{path.name}: {name}"))
        else:
            listed[name] = match[1]
    return listed, wrong


def _tag_file_names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir() if path.is_file()}
