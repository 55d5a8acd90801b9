"""A folder in BagIt form (RFC 8493): its manifests, and what of it is not as they say."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

DATA: Final = "data"
DECLARATION: Final = "bagit.txt"
INFO: Final = "bag-info.txt"
MANIFEST: Final = "manifest-sha256.txt"
TAG_MANIFEST: Final = "tagmanifest-sha256.txt"
_DECLARED: Final = b"BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n"
_LINE: Final = re.compile(r"([0-9a-f]{64})  ([^\s].*)")
_UNFIT: Final = re.compile(r"[\r\n%\\]")


class Problem(NamedTuple):
    """What is wrong with a pack: of which kind, and what it is about."""

    kind: str
    what: str


def sha256_of(path: Path) -> str:
    """Return the hash of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def begin(folder: Path, info: Mapping[str, str]) -> None:
    """Write the declaration, what is said of the bag, and the manifest of its payload, which is whole.

    Errors: `UsageError` for a file name that `sha256sum -c` would not find.
    """
    payload = [path for path in sorted((folder / DATA).rglob("*")) if path.is_file()]
    size = sum(path.stat().st_size for path in payload)
    said = {**info, "Payload-Oxum": f"{size}.{len(payload)}"}
    (folder / DECLARATION).write_bytes(_DECLARED)
    (folder / INFO).write_text("".join(f"{name}: {value}\n" for name, value in said.items()), "utf-8", newline="\n")
    _write_manifest(folder, MANIFEST, payload)


def finish(folder: Path) -> None:
    """Write the manifest of the tag files: of all but the payload."""
    _write_manifest(folder, TAG_MANIFEST, [folder / name for name in sorted(_tag_files(folder) - {TAG_MANIFEST})])


def _write_manifest(folder: Path, name: str, files: Iterable[Path]) -> None:
    lines = []
    for path in files:
        inner = path.relative_to(folder).as_posix()
        if _UNFIT.search(inner):
            raise UsageError(f"{inner}: sha256sum does not find a file of such a name: rename it")
        lines.append(f"{sha256_of(path)}  {inner}\n")
    (folder / name).write_text("".join(lines), "utf-8", newline="\n")


def problems(folder: Path) -> list[Problem]:
    """Return what is not as the manifests say, sorted by file: changed, removed and added files, and changed manifests.

    Errors: `UsageError` where it is no bag.
    """
    if not (folder / DECLARATION).is_file() and not (folder / MANIFEST).is_file():
        raise UsageError(f"{folder}: no evidence pack: name the folder that drivelint pack --out wrote")
    found = [Problem("link", _inner(folder, path)) for path in folder.rglob("*") if path.is_symlink()]
    if (folder / DECLARATION).is_file() and (folder / DECLARATION).read_bytes() != _DECLARED:
        found.append(Problem("file changed", DECLARATION))
    for manifest, names in ((TAG_MANIFEST, _tag_files(folder) - {TAG_MANIFEST}), (MANIFEST, _payload(folder))):
        if not (folder / manifest).is_file():
            found.append(Problem("file removed", manifest))
            continue
        listed, wrong = _read_manifest(folder / manifest, payload=manifest == MANIFEST)
        found += wrong
        found += [Problem("file removed", name) for name in listed.keys() - names]
        found += [Problem("file added", name) for name in names - listed.keys()]
        for name in sorted(listed.keys() & names):
            if sha256_of(folder / name) != listed[name]:
                found.append(Problem("manifest changed" if name == MANIFEST else "file changed", name))
    return sorted(set(found), key=lambda each: (each.what, each.kind))


def _read_manifest(path: Path, *, payload: bool) -> tuple[dict[str, str], list[Problem]]:
    """Return file -> hash as a manifest says, and its lines that are none of a manifest."""
    listed: dict[str, str] = {}
    wrong = []
    for no, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
        match = _LINE.fullmatch(line)
        name = match[2] if match else ""
        inner = PurePosixPath(name)
        if match is None or name in listed:
            wrong.append(Problem("manifest not readable", f"{path.name} line {no}"))
        elif inner.is_absolute() or ".." in inner.parts or (inner.parts[0] == DATA) is not payload:
            wrong.append(Problem("manifest names a file outside", f"{path.name}: {name}"))
        else:
            listed[name] = match[1]
    return listed, wrong


def _inner(folder: Path, path: Path) -> str:
    return path.relative_to(folder).as_posix()


def _payload(folder: Path) -> set[str]:
    return {_inner(folder, path) for path in (folder / DATA).rglob("*") if path.is_file()}


def _tag_files(folder: Path) -> set[str]:
    found = {_inner(folder, path) for path in folder.rglob("*") if path.is_file()}
    return {name for name in found if PurePosixPath(name).parts[0] != DATA}
