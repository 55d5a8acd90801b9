"""Reads and applies waivers: findings that a named owner accepts until a given day. An example:

    [[waiver]]
    rule = "ukhc.r162.*"           # a rule's id, or a glob over ids
    drive = "near-miss-*"          # optional globs: drive_id, ego, object, profile
    object = "3"
    from_s = 8.0                   # optional: limits of the failing stretch, in seconds since the drive's first time stamp
    to_s = 9.5
    reason = "the test track's lane is wider than the map says: ticket 17"
    owner = "jo@example.org"
    expires = 2027-03-31           # the last day on which it counts

Waivers are in a separate file (`--waivers FILE`), in `drivelint.toml`, or in `pyproject.toml` as [[tool.drivelint.waiver]]. A waived
finding is shown with the reason, and does not gate. A waiver that has expired has no effect. A waiver that matches no finding is
reported, because it may have a spelling mistake.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from datetime import date, datetime
from difflib import get_close_matches
from fnmatch import fnmatchcase
from itertools import pairwise
from math import isfinite
from typing import TYPE_CHECKING, Any, Final

from drivelint.catalogue.load import load_rules
from drivelint.errors import UsageError
from drivelint.gate.match import seconds_since_start
from drivelint.globs import glob_length_problem
from drivelint.phrases import hint
from drivelint.result.counts import one_finding_per_event
from drivelint.result.gate import Waiver
from drivelint.settings import settings_table
from drivelint.toml_text import parse_toml

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from drivelint.result.model import Result

    Row = Mapping[str, Any]

_REQUIRED_KEYS: Final = ("rule", "reason", "owner", "expires")
_PATTERN_KEYS: Final = ("drive", "ego", "object", "profile")
_TIME_KEYS: Final = ("from_s", "to_s")
_WAIVER_HEAD: Final = re.compile(r"\s*\[\[\s*(?:tool\.drivelint\.)?(waiver|\"waiver\"|'waiver')\s*\]\]")


def read(file: Path, *, only_waivers: bool = True) -> list[Waiver]:
    """Return the waivers of a TOML file, in the order of the file.

    `only_waivers`: the file has nothing but waivers; False: it also has other settings. Errors: `UsageError` with file and line for invalid
    TOML, an unknown key (with the most similar known key), a missing rule, reason, owner or expiry, or a value of the wrong type.
    """
    if file.exists() and not file.is_file():
        raise UsageError(f"{file}: waivers must be in a file, but this is not one")
    try:
        text = file.read_text(encoding="utf-8")
        content = parse_toml(text) if only_waivers else settings_table(file)
    except FileNotFoundError as error:
        raise UsageError(f"{file}: no such file of waivers") from error
    except OSError as error:
        raise UsageError(f"{file}: cannot be read: {error.strerror or error}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise UsageError(f"{file}: not TOML: {error}") from error
    if only_waivers and (excess := sorted(set(content) - {"waiver"})):
        raise UsageError(f"{file}: unknown key {excess[0]!r}: it may have only tables [[waiver]]")
    tables = content.get("waiver", [])
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise UsageError(f"{file}: waiver must be tables, each headed [[waiver]]")
    if only_waivers and not tables:
        raise UsageError(f"{file}: no table [[waiver]] in it")
    places = _lines_of_heads_and_keys(text, len(tables))
    return [_parse_waiver(table, file, place) for table, place in zip(tables, places, strict=True)]


def states_and_matches(
    waivers: Sequence[Waiver], result: Result, today: date
) -> tuple[tuple[Waiver, ...], dict[str, int]]:
    """Return the waivers with their state on the day `today`, and finding_id -> index of the first waiver that matches
    the finding and has not expired."""
    drives = {row["drive_id"]: row for row in result.drives.to_pylist()}
    expired = [date.fromisoformat(waiver.expires) < today for waiver in waivers]
    rows = result.findings.to_pylist()
    waived: dict[str, int] = {}
    counts: list[int] = []
    for number, waiver in enumerate(waivers):
        matched = [row for row in rows if _matches(waiver, row, drives[row["drive_id"]])]
        counts.append(len(one_finding_per_event(matched)))
        if not expired[number]:
            for row in matched:
                waived.setdefault(row["finding_id"], number)
    stated = (
        replace(
            waiver,
            findings=counts[n],
            unknown_rule=_unknown_rule_sentence(waiver.rule, result),
            state="expired" if expired[n] else "active" if counts[n] else "unmatched",
        )
        for n, waiver in enumerate(waivers)
    )
    return tuple(stated), waived


def _unknown_rule_sentence(rule_id: str, result: Result) -> str:
    """Return a sentence that no rule has this id, with the most similar id; '' if the rule exists, or the id is a pattern."""
    run_rules = result.rules["rule_id"].to_pylist()
    if rule_id in run_rules or any(sign in rule_id for sign in "*?["):
        return ""
    dirs = () if result.run_options is None else result.run_options.rules_dirs
    if not all(folder.is_dir() for folder in dirs):
        return ""
    rule_ids = sorted({*run_rules, *load_rules(dirs)})
    if rule_id in rule_ids:
        return ""
    near = get_close_matches(rule_id, rule_ids, n=1)
    return "no rule has this id; " + (f"did you mean {near[0]!r}?" if near else "drivelint rules list shows them all")


def _matches(waiver: Waiver, row: Row, drive: Row) -> bool:
    """Return whether a finding matches all conditions of a waiver."""
    columns = {"rule": "rule_id", "ego": "ego_id", "object": "object_id", "profile": "profile"}
    patterns = ((getattr(waiver, name), row[column]) for name, column in columns.items())
    if any(pattern is not None and not fnmatchcase(text or "", pattern) for pattern, text in patterns):
        return False
    names = (row["drive_id"], drive["file_name"])
    if waiver.drive is not None and not any(fnmatchcase(name, waiver.drive) for name in names):
        return False
    after = waiver.from_s is None or waiver.from_s <= seconds_since_start(row["t_start_ns"], drive)
    return after and (waiver.to_s is None or seconds_since_start(row["t_end_ns"], drive) <= waiver.to_s)


def _parse_waiver(table: Row, file: Path, lines_of_head_and_keys: tuple[int, Mapping[str, int]]) -> Waiver:
    head, lines = lines_of_head_and_keys

    def error_at_key(key: str, why: str) -> UsageError:
        return UsageError(f"{file}:{lines.get(key, head)}: waiver: {why}")

    keys = (*_REQUIRED_KEYS, *_PATTERN_KEYS, *_TIME_KEYS)
    for key in table:
        if key not in keys:
            raise error_at_key(key, f"unknown key {key!r}; {hint(key, keys)}")
    if lacking := [key for key in _REQUIRED_KEYS if key not in table]:
        raise error_at_key("", f"{' and '.join(lacking)} missing: a waiver needs an owner, a reason and a date")
    _refuse_empty_or_too_long_texts(table, error_at_key)
    for key in _TIME_KEYS:
        if key in table and (
            isinstance(table[key], bool) or not isinstance(table[key], int | float) or not isfinite(table[key])
        ):
            raise error_at_key(key, f"{key} = {table[key]!r}: must be seconds since the drive's first time stamp")
    if table.get("from_s", 0) > table.get("to_s", float("inf")):
        raise error_at_key("to_s", "to_s is before from_s")
    try:
        expires = parse_date(table["expires"])
    except ValueError as error:
        raise error_at_key("expires", f"expires = {table['expires']!r}: must be a day such as 2027-03-31") from error
    words = {key: table[key] for key in ("rule", "reason", "owner", *_PATTERN_KEYS, *_TIME_KEYS) if key in table}
    return Waiver(where=f"{file}:{head}", expires=expires.isoformat(), **words)


def _refuse_empty_or_too_long_texts(table: Row, error_at_key: Callable[[str, str], UsageError]) -> None:
    for key in ("rule", "reason", "owner", *_PATTERN_KEYS):
        if key in table and not (isinstance(table[key], str) and table[key].strip()):
            raise error_at_key(key, f"{key} = {table[key]!r}: must be a text, and not an empty one")
    for key in ("rule", *_PATTERN_KEYS):
        if problem := glob_length_problem(table.get(key, "")):
            raise error_at_key(key, f"{key}: {problem}")


def parse_date(value: object) -> date:
    """Return a day from a TOML date or a text such as 2027-03-31. Errors: `ValueError`."""
    if isinstance(value, date) and not isinstance(value, datetime):
        return value
    if isinstance(value, str) and re.fullmatch(r"\d{4}-\d{2}-\d{2}", value):
        return date.fromisoformat(value)
    raise ValueError(value)


def _lines_of_heads_and_keys(text: str, n_waivers: int) -> list[tuple[int, dict[str, int]]]:
    """Return, for each waiver, the line of its head and of each key; line 1 if the heads cannot be found."""
    lines = text.splitlines()
    heads = [number for number, line in enumerate(lines, 1) if _WAIVER_HEAD.match(line)]
    if len(heads) != n_waivers:  # an inline array, or a head inside a multi-line string
        return [(1, {})] * n_waivers
    places = []
    for head, end in pairwise([*heads, len(lines) + 1]):
        keys: dict[str, int] = {}
        for number in range(head + 1, end):
            if key := re.match(r"\s*[\"']?([\w-]+)[\"']?\s*=", lines[number - 1]):
                keys.setdefault(key.group(1), number)
        places.append((head, keys))
    return places
