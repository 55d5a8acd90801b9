"""Which rules the log can decide, and what to provide to decide more: by signal, then by rule."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from rich.console import Group
from rich.table import Table
from rich.text import Text

from drivelint.phrases import listed, plural
from drivelint.result.counts import grouped

if TYPE_CHECKING:
    from rich.console import RenderableType

    from drivelint.inspect.model import Drive, Ego

_NAMED: Final = 6
"""Egos that a line names before it says how many more there are."""


def decidable_rules(drive: Drive, log: str) -> Group:
    """Return the rules that each ego can and cannot decide; egos that lack the same signals share a paragraph."""
    egos_told = drive.egos or ([drive.supposed] if drive.supposed else [])
    alike = grouped(egos_told, lambda ego: tuple(item.signal for item in ego.missing))
    parts: list[RenderableType] = []
    for egos in sorted(alike.values(), key=lambda group: -len(group[0].can)):
        parts += _about(drive, egos, log)
    return Group(*parts)


def _about(drive: Drive, egos: list[Ego], log: str) -> list[RenderableType]:
    ego, n = egos[0], len(drive.rules)
    selection = listed(drive.selection, _NAMED)
    who = ""
    if not drive.egos:
        who = f" with --ego {ego.actor.actor_id}"
    elif len(drive.egos) > 1:
        who = f" for {'ego' if len(egos) == 1 else 'egos'} {listed([e.actor.actor_id for e in egos], _NAMED)}"
    style = "bold green" if len(ego.can) == n else "bold yellow" if ego.can else "bold red"
    parts: list[RenderableType] = [
        Text(f"{log} can decide {len(ego.can)} of {n} rules ({selection}){who}.", style=style)
    ]
    if ego.can:
        parts.append(Text(f"It can: {', '.join(_short(rule, drive) for rule in ego.can)}.", style="dim"))
    if ego.missing:
        parts += [Text("\nTo decide more, provide:", style="bold"), _by_signal(ego)]
        parts += [Text("\nWhich rules wait for what:", style="bold"), _by_rule(ego)]
    return parts


def _short(rule_id: str, drive: Drive) -> str:
    """Return a rule's id without its pack where all are of one."""
    packs = {rule.partition(".")[0] for rule in drive.rules}
    return rule_id.partition(".")[2] if len(packs) == 1 else rule_id


def _by_signal(ego: Ego) -> Table:
    grid = _grid()
    for item in ego.missing:
        waiting = f"{plural(len(item.rules), 'rule')} wait{'s' if len(item.rules) == 1 else ''} for it"
        alone = ""
        if len(item.alone) < len(item.rules):
            alone = f", {len(item.alone)} of them for nothing else" if item.alone else ", and for something else too"
        text = Text(item.provide)
        text.append(f"\nNow: {item.reason}. {waiting}{alone}.", style="dim")
        grid.add_row(item.signal, text)
    return grid


def _by_rule(ego: Ego) -> Table:
    """Return the rules that wait for the same together."""
    grid = _grid()
    waiting = grouped(ego.cannot, lambda rule: tuple(rule.missing))
    for missing, rules in sorted(waiting.items(), key=lambda item: (-len(item[1]), item[0])):
        ids = (f"{rule.rule_id}{' (can be broken, not kept)' if rule.breach_only else ''}" for rule in rules)
        grid.add_row(" + ".join(missing), Text(", ".join(ids)))
    return grid


def _grid() -> Table:
    grid = Table.grid(padding=(0, 2, 0, 0))
    grid.add_column(style="yellow", overflow="fold")
    grid.add_column(overflow="fold", ratio=1)
    return grid
