"""Hashes everything that determines a result besides the log. These hashes are part of the key of a result."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import msgspec

from drivelint import __version__, catalogue
from drivelint.audit.bucket import download, find_object, url_of_path
from drivelint.audit.model import digest
from drivelint.engine.profiles import DEFAULT_PROFILES, load_profiles, profile_table
from drivelint.receipts.inputs import file_sha256
from drivelint.resources import folder
from drivelint.result import collect

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.audit.model import JudgeSettings
    from drivelint.drive.trace import DriveInput

_LIBRARIES = ("duckdb", "duckdb-extension-spatial", "pyarrow", "numpy")


def versions() -> dict[str, str]:
    """Return the versions of drivelint and of the libraries that can affect a verdict's bytes, and the hash of drivelint's SQL."""
    return {"drivelint": __version__, **{name: version(name) for name in _LIBRARIES}, "queries": _queries_sha256()}


@cache
def _queries_sha256() -> str:
    whole = hashlib.sha256()
    for root in (folder("queries"), folder("schemas")):
        for file in sorted(path for path in root.rglob("*") if path.suffix in {".sql", ".toml"}):
            whole.update(f"{file.relative_to(root).as_posix()}\0".encode() + file.read_bytes())
    return whole.hexdigest()


def rule_table(settings: JudgeSettings) -> pa.Table:
    """Return the table `rule` of the selected rules. Errors: `UsageError`, `RuleError` for wrong settings."""
    rules = catalogue.select_rules(catalogue.load_rules(settings.rules_dirs), settings.rules, settings.ignore)
    params = catalogue.parse_params(rules, settings.params)
    return collect.rule_table(rules, params, settings.profiles or DEFAULT_PROFILES)


def run_id(settings: JudgeSettings) -> str:
    """Return the hash of rules, which of them were named, their parameters, profiles, `robustness`, and versions. Errors: as
    `rule_table`."""
    rules = rule_table(settings).select(["rule_id", "rule_version", "params", "profiles"]).to_pylist()
    profiles = profile_table(load_profiles(settings.rules_dirs), settings.profiles).to_pylist()
    selection = catalogue.select_rules(catalogue.load_rules(settings.rules_dirs), settings.rules, settings.ignore)
    named_ids = sorted(rule.id for rule in selection if rule.is_named)
    return digest([versions(), rules, named_ids, profiles, settings.robustness])


class OptionHashes:
    """Hashes the options of drives. A map or mapping that many drives share is read once."""

    def __init__(self) -> None:
        self._known: dict[str, str] = {}
        self._file = cache(_content_hash)

    def hash_of(self, options: DriveInput) -> str:
        """Return the hash of a drive's options and of the content of its map and mapping.

        For a map that cannot be read, the hash uses its name; drives with that map are refused until it can be read.
        """
        values: dict[str, Any] = msgspec.to_builtins(options, enc_hook=str)
        name = digest(values)
        if name not in self._known:
            for key in ("map", "map_dir"):
                if values[key] is not None:
                    values[key] = self._file(values[key])
            if values["mapping"] is not None and Path(values["mapping"]).is_file():
                values["mapping"] = self._file(values["mapping"])
            self._known[name] = digest(values)
        return self._known[name]


def _content_hash(path: str) -> str:
    where = Path(path)
    if (url := url_of_path(where)) is not None:
        remote = find_object(url)
        with TemporaryDirectory(prefix="drivelint-map-") as home:
            return f"unread {url}" if remote is None else file_sha256(download(remote, Path(home)))
    try:
        if where.is_dir():
            files = sorted(file for file in where.rglob("*") if file.is_file())
            return digest([[file.relative_to(where).as_posix(), file_sha256(file)] for file in files])
        return file_sha256(where)
    except OSError:
        return f"unread {path}"
