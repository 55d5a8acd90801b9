"""Chooses the rules of a run without `--rules`: those of the nation whose law applies, from the user or the given map."""

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


def chosen_selectors(
    selectors: tuple[str, ...], rules_dirs: Sequence[Path], options: DriveInput, library: MapLibrary | None = None
) -> tuple[str, ...]:
    """Return the selectors of a run: what the user chose, else those of the stable rules of the packs of the nation.

    None stands for those of everywhere, which `select_rules` knows. Errors: `UsageError` for a condition that does not exist; `RuleError`.
    """
    packs = () if selectors else packs_of_nation(catalogue.load_rules(rules_dirs), options, library)
    return tuple(f"{pack},status:stable" for pack in packs) if len(packs) > 1 else selectors


def with_chosen_rules(options: Options, library: MapLibrary | None = None) -> Options:
    """Return the options with the selectors of the run. Errors: as there."""
    return replace(options, rules=chosen_selectors(options.rules, options.rules_dirs, options, library))


def packs_of_nation(
    rules: Mapping[str, Rule], options: DriveInput, library: MapLibrary | None = None
) -> tuple[str, ...]:
    """Return the packs of a run without `--rules`, in the nation of `--env` or of the map of `--map`.

    These hold for all logs of a run. Of a log that alone says its nation, the report's first line names the packs of its law. `library`:
    keeps the map once it is read. Errors: `UsageError` for a condition that does not exist.
    """
    nation = dict(conditions.parse(options.env)).get("nation") or _nation_of_map(options, library)
    return catalogue.default_packs(rules, nation)


def _nation_of_map(options: DriveInput, library: MapLibrary | None) -> str | None:
    """Return the nation of the given map; None: it states none, or cannot be read, which is an error when a drive needs it."""
    with suppress(DriveLintError):
        return (library or MapLibrary(options)).given_nation() if options.map else None
    return None
