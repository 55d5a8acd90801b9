"""Copies files into a pack that is being written."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from drivelint.catalogue import Rule


def copy_into_new_folder(source: Path, target_folder: Path, pack_folder: Path) -> str:
    """Copy a file or folder into the new folder `target_folder` of the pack; return the copy's path in the pack."""
    target = make_new_folder(target_folder, pack_folder) / source.name
    if source.is_dir():
        shutil.copytree(source, target)
    else:
        shutil.copyfile(source, target)
    return target.relative_to(pack_folder).as_posix()


def copy_rule_files(rules: Iterable[Rule], pack_folder: Path) -> None:
    """Copy the files of rules into the pack."""
    for rule in rules:
        place = pack_folder / "data" / "rules" / rule.pack
        place.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(rule.path, place / rule.path.name)


def copy_rules_dirs(rules_dirs: Iterable[Path], pack_folder: Path) -> list[str]:
    """Copy folders of rules that are not drivelint's own; return their paths in the pack."""
    place = pack_folder / "data" / "rules_dirs"
    return [
        copy_into_new_folder(folder.resolve(), place / str(no), pack_folder) for no, folder in enumerate(rules_dirs)
    ]


def write_files(files: Mapping[str, bytes], target_folder: Path, pack_folder: Path) -> None:
    """Write files into the new folder `target_folder` of the pack."""
    make_new_folder(target_folder, pack_folder)
    for name, content in files.items():
        (target_folder / name).write_bytes(content)


def make_new_folder(target_folder: Path, pack_folder: Path) -> Path:
    """Create a folder in the pack. Errors: `UsageError` for an unsafe name: the name may be an id from an untrusted result."""
    if not target_folder.resolve().is_relative_to(pack_folder.resolve() / "data") or target_folder.is_dir():
        raise UsageError(f"{target_folder.name}: no id of a finding or a drive: check the drives again")
    target_folder.mkdir(parents=True)
    return target_folder
