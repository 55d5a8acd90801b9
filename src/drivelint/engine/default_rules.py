"""Chooses the rules of a run without `--rules`: the packs of the nation that the user or the user's map states."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from drivelint import catalogue
from drivelint.drive import conditions
from drivelint.engine.judging_options import JudgingOptions
from drivelint.engine.map_library import MapLibrary
from drivelint.errors import DriveLintError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from drivelint.catalogue import Rule
    from drivelint.drive.trace import DriveInput

Options = TypeVar("Options", bound=JudgingOptions)


def selectors_of_run(
    selectors: tuple[str, ...], rules_dirs: Sequence[Path], options: DriveInput, library: MapLibrary | None = None
) -> tuple[str, ...]:
    """Return the selectors of a run: those of the user, else selectors of the stable rules of the nation's packs.

    Empty: only the pack for all nations applies, which `select_rules` selects by default. Errors: `UsageError` for an unknown condition;
    `RuleError`.
    """
    packs = () if selectors else packs_of_nation(catalogue.load_rules(rules_dirs), options, library)
    return tuple(f"{pack},status:stable" for pack in packs) if len(packs) > 1 else selectors


def with_selectors_of_run(options: Options, library: MapLibrary | None = None) -> Options:
    """Return the options with the selectors of the run. Errors: as `selectors_of_run`."""
    return replace(options, rules=selectors_of_run(options.rules, options.rules_dirs, options, library))


def packs_of_nation(
    rules: Mapping[str, Rule], options: DriveInput, library: MapLibrary | None = None
) -> tuple[str, ...]:
    """Return the packs of a run without `--rules`, for the nation that `--env` or the map of `--map` states.

    They apply to all logs of the run. If only a log states its nation, the first line of the report names the packs of its law. `library`:
    caches the map. Errors: `UsageError` for an unknown condition.
    """
    nation = dict(conditions.parse_env_settings(options.env)).get("nation") or _nation_of_map(options, library)
    return catalogue.default_packs(rules, nation)


def _nation_of_map(options: DriveInput, library: MapLibrary | None) -> str | None:
    """Return the nation of the map of `--map`. None: no map, no nation, or an unreadable map (an error once a drive needs it)."""
    with suppress(DriveLintError):
        return (library or MapLibrary(options)).nation_of_user_map() if options.map else None
    return None
