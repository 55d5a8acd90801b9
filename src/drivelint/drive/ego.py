"""Chooses the ego: the actor that the user names, else the actor that the log or the mapping names."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, Final

from drivelint.drive.trace import ASSUMED_SIZE_CHECK, MOTOR_VEHICLES, SIZE_COLUMNS, QualityFinding
from drivelint.errors import TraceError
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from drivelint.drive.actors import Actors
    from drivelint.drive.trace import EgoSize

ALL_EGOS = "all"
MOST_UNREPORTED_SIZE_DIFFERENCE_M: Final = 0.05
"""A larger difference between the user's and the log's size is reported."""


def asks_for_all_egos(ego_option: str | None, ids: Collection[str]) -> bool:
    """Return whether the user requests every motor vehicle as ego: the option is `all`, and no actor has the id `all`."""
    return ego_option == ALL_EGOS and ALL_EGOS not in ids


def choose_egos(
    path: Path,
    actors: Actors,
    ego_option: str | None,
    named_egos: list[str],
    *,
    ego_required: bool = True,
    why: str = "",
) -> tuple[list[str], list[QualityFinding]]:
    """Return the ids of the egos and the findings about the choice.

    `ego_option` is the user's id or `all` (every motor vehicle, except in a log with an actor whose id is `all`); `named_egos` are the
    ids that the log or the mapping names; `why`: why it names none. If there is no ego and `ego_required` is false, the ids are empty and
    a finding states it.
    Errors: `TraceError` if a required ego is missing, or the log has no actor with the user's id.
    """
    ids = set(actors.ids)
    if asks_for_all_egos(ego_option, ids):
        return _every_motor_vehicle(path, actors)
    if ego_option is not None:
        if ego_option not in ids:
            raise TraceError(
                f"{path}: no actor {ego_option!r} in this log: use --ego ID (ids: {name_list(actors.ids)})"
            )
        return [ego_option], []
    egos = sorted(ids.intersection(named_egos))
    if not egos:
        absent = "the log does not name the ego" + (f" ({why})" if why else "")
        if named_egos:
            absent = f"the log's ego {name_list([repr(name) for name in named_egos])} has no states"
        message = f"no ego: {absent}: use --ego ID or --ego all (ids: {name_list(actors.ids)})"
        if not ego_required:
            return [], [QualityFinding("no_ego", "warning", message)]
        raise TraceError(f"{path}: {message}")
    if len(egos) > 1:
        message = f"the log names {len(egos)} egos ({name_list(egos)}): each is judged; choose one with --ego ID"
        return egos, [QualityFinding("ego_count", "warning", message, len(egos))]
    return egos, []


def fill_sizes(actors: Actors, egos: list[str], size: EgoSize | None) -> list[QualityFinding]:
    """Give egos without a size the user's size, in place, and return findings about it; a size that the log has is kept."""
    if size is None:
        return []
    findings = []
    for i in (actors.ids.index(name) for name in egos):
        sizes_of_log = actors.sizes["length_m"][i], actors.sizes["width_m"][i]
        if any(map(isnan, sizes_of_log)):
            message = "size from --ego-size, not recorded"
            findings.append(QualityFinding(ASSUMED_SIZE_CHECK, "info", message, actor_id=actors.ids[i]))
        for name, has, option in zip(SIZE_COLUMNS, sizes_of_log, size[:2], strict=False):
            if isnan(has):
                actors.sizes[name][i] = option
            elif abs(has - option) > MOST_UNREPORTED_SIZE_DIFFERENCE_M:
                message = (
                    f"--ego-size gives {actors.ids[i]} a {name.removesuffix('_m')} of {option:g} m, but the log "
                    f"states {has:g} m: the value of the log is used"
                )
                findings.append(QualityFinding("ego_size", "warning", message, actor_id=actors.ids[i]))
    return findings


def _every_motor_vehicle(path: Path, actors: Actors) -> tuple[list[str], list[QualityFinding]]:
    egos = [i for i, kind in zip(actors.ids, actors.classes, strict=True) if kind in MOTOR_VEHICLES]
    unknown = [i for i, kind in zip(actors.ids, actors.classes, strict=True) if kind is None]
    if not egos:
        why = "no actor's class is known" if len(unknown) == len(actors.ids) else "no actor is a motor vehicle"
        raise TraceError(f"{path}: no ego: {why}: use --ego ID or --ego all (ids: {name_list(actors.ids)})")
    if not unknown:
        return egos, []
    message = f"actors without a known class are not judged as egos ({name_list(unknown)})"
    return egos, [QualityFinding("ego_count", "warning", message, len(unknown))]
