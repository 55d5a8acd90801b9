"""Who is judged: the actor the user names, else the one the log or the mapping names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.errors import TraceError
from drivelint.ingest.order import listed
from drivelint.ingest.trace import MOTOR_VEHICLES, Finding

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.ingest.actors import Actors

EVERY = "all"


def choose(
    path: Path, actors: Actors, asked: str | None, named: list[str], *, needed: bool = True
) -> tuple[list[str], list[Finding]]:
    """Return the ids of the egos and what is to be said about the choice.

    `asked` is the user's id or `all` (every motor vehicle, except in a log whose actor is itself called `all`);
    `named` are the log's or mapping's. Where nobody names one and none is `needed`, there is none and a finding says so.
    Errors: `TraceError` when there is no ego though needed, or no such actor.
    """
    ids = set(actors.ids)
    if asked == EVERY and EVERY not in ids:
        return _every(path, actors)
    if asked is not None:
        if asked not in ids:
            raise TraceError(f"{path}: no actor {asked!r} in this log: use --ego ID (ids: {listed(actors.ids)})")
        return [asked], []
    egos = sorted(ids.intersection(named))
    if not egos:
        absent = (
            f"the log's ego {listed(named)} has no states" if named else "the log does not say which actor is the ego"
        )
        if not needed:
            return [], [Finding("no_ego", "warning", f"no ego: {absent}: nothing is judged without --ego ID")]
        raise TraceError(f"{path}: no ego: {absent}: use --ego ID (ids: {listed(actors.ids)})")
    if len(egos) > 1:
        message = f"the log names {len(egos)} egos ({listed(egos)}): each is judged; choose one with --ego ID"
        return egos, [Finding("ego_count", "warning", message, len(egos))]
    return egos, []


def _every(path: Path, actors: Actors) -> tuple[list[str], list[Finding]]:
    egos = [i for i, kind in zip(actors.ids, actors.classes, strict=True) if kind in MOTOR_VEHICLES]
    unknown = [i for i, kind in zip(actors.ids, actors.classes, strict=True) if kind is None]
    if not egos:
        why = "no actor's class is known" if len(unknown) == len(actors.ids) else "no actor is a motor vehicle"
        raise TraceError(f"{path}: no ego: {why}: use --ego ID (ids: {listed(actors.ids)})")
    if not unknown:
        return egos, []
    message = f"actors of unknown class are not taken as egos ({listed(unknown)})"
    return egos, [Finding("ego_count", "warning", message, len(unknown))]
