"""Copies files into a pack that is being written."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from drivelint.catalogue import Rule


def copy(source: Path, place: Path, work: Path) -> str:
    """Copy a file or folder into the new folder `place` of the pack; return the copy's path in the pack."""
    target = make_folder(place, work) / source.name
    if source.is_dir():
        shutil.copytree(source, target)
    else:
        shutil.copyfile(source, target)
    return target.relative_to(work).as_posix()


def copy_rules(rules: Iterable[Rule], work: Path) -> None:
    """Copy the files of rules into the pack."""
    for rule in rules:
        place = work / "data" / "rules" / rule.pack
        place.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(rule.path, place / rule.path.name)


def copy_rules_dirs(rules_dirs: Iterable[Path], work: Path) -> list[str]:
    """Copy folders of rules that are not drivelint's own; return their paths in the pack."""
    place = work / "data" / "rules_dirs"
    return [copy(folder.resolve(), place / str(no), work) for no, folder in enumerate(rules_dirs)]


def write_files(files: Mapping[str, bytes], place: Path, work: Path) -> None:
    """Write files into the new folder `place` of the pack."""
    make_folder(place, work)
    for name, content in files.items():
        (place / name).write_bytes(content)


def make_folder(place: Path, work: Path) -> Path:
    """Create a folder in the pack. Errors: `UsageError` for an unsafe name: the name may be an id from an untrusted result."""
    if not place.resolve().is_relative_to(work.resolve() / "data") or place.is_dir():
        raise UsageError(f"{place.name}: no id of a finding or a drive: check the drives again")
    place.mkdir(parents=True)
    return place
