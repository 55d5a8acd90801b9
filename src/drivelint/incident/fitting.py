"""Fits the content into two pages: a reason loses the titles of its rules before any reason is left out."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from drivelint.phrases import plural

if TYPE_CHECKING:
    from collections.abc import Sequence

_ROOM: Final = {"broken": 1500, "kept": 300, "excused": 80, "reasons": 350}
"""The fewest characters of each part on the page; the number of left-out texts is printed."""
_FIRST: Final = ("broken", "reasons")
"""Parts that are printed whole before any other, in this order."""
_MAY_GO: Final = frozenset({"kept", "excused"})
"""Parts whose number stands in the party's first line."""
_WASTE: Final = {"broken": 30}
"""Characters that the end of a text's last line leaves empty, where each text begins a line."""
_ALL_ROOM: Final = 3300
"""Characters of all parts of both parties: the others may use the room that one leaves."""
_SECOND_ROOM: Final = 110
"""Characters that fit where the table second by second has a row less than its most."""
_JOIN: Final = 2
"""Characters between two texts."""
SHARED_HEAD: Final = 100
"""Characters of the head of the reasons that both parties share, with the end of the line before it."""
_TITLES_NOTE_CHARACTERS: Final = 80
"""Characters of the sentence that says where the titles are that were left out."""
_WIDE, _CELL, _FACT, _CHECK = 92, 43, 41, 98
"""Characters of a line in the widest font that may print the sheet: across page 1, in a column of the parties or the facts, in a row of
the hashes."""
_LINE_PX, _TEXT_PX = 13.7, 15.7
"""Heights of a line in the tables of page 1, and of its first sentences."""
_FIRST_PX: Final = 465
"""Greatest height of the finding and the parties on page 1 with which the lists of missing records still fit below them."""
_CHECK_LINE: Final = 125
"""Characters of the columns of page 2 that a line of the hashes takes."""
_CELLS: Final = ("delta_v", "fastest", "lane", "lights")


_Part: TypeAlias = "tuple[dict[str, Any], str, int]"
"""The texts of a party by part, the name of one part, and the characters that this part may take."""


class Reason(NamedTuple):
    """Why some rules are not decided, and the titles of these rules."""

    why: str
    titles: tuple[str, ...]

    @property
    def full(self) -> str:
        """The reason with the titles of its rules."""
        return f"{', '.join(self.titles)}: {self.why}"

    @property
    def short(self) -> str:
        """The reason with the number of its rules."""
        return f"{self.why} ({plural(len(self.titles), 'rule')})"


class Fitting(NamedTuple):
    """The first of some texts, how many more there are, and whether some of those shown are short forms."""

    texts: list[str]
    more: int
    is_short: bool = False


def is_crowded(page: dict[str, Any]) -> bool:
    """Whether page 1, with the finding and the parties in `content`, has no room left for the missing records."""
    sure, rests, drive = page["sure"], page["rests"], page["drive"]
    facts = [
        8
        + _lines(
            f"{drive['map_name']} {page['road_id']} {page['place'].lanelet_id} {page['coordinates']} {page['hand']}",
            _FACT,
        ),
        10 + _lines(rests, _FACT) + _lines(sure["by"], _FACT),
    ]
    parties = page["parties"]
    rows = [[_lines(f"{p['kind']}, {p['size']} ({p['size_source']})", _CELL) for p in parties]]
    rows += [[_lines(p[name], _CELL) for p in parties] for name in _CELLS]
    rows += [[sum(_lines(each, _CELL) for each in p["slowed"]) or 1 for p in parties]]
    against = [page["against"] or "", page["least"] or "", *(f"contact also {each}" for each in page["contacts"].texts)]
    across = [page["story"], page["what"]]
    lines = max(facts) + sum(max(row) for row in rows) + _lines(" ".join(against), 2 * _CELL)
    lines += _lines(", ".join(page["drawn"]), _WIDE)
    return lines * _LINE_PX + sum(_lines(each, _WIDE) for each in across) * _TEXT_PX > _FIRST_PX


def check_room(texts: Sequence[str]) -> int:
    """Return the characters that the lines of the hashes take, from the columns, beyond one line each."""
    return _CHECK_LINE * sum(_lines(text, _CHECK) - 1 for text in texts)


def _lines(text: str, width: int) -> int:
    return len(wrap(text, width))


def shared_reasons(parties: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Take the reasons that all parties share, with the same rules, out of each; return them as a part of their own."""
    given = [told["reasons"] for told in parties if "reasons" in told]
    shared = [reason for reason in given[0] if all(reason in others for others in given[1:])] if len(given) > 1 else []
    for told in parties:
        if "reasons" in told:
            told["reasons"] = [reason for reason in told["reasons"] if reason not in shared]
    return {"reasons": shared}


def fit(parties: Sequence[dict[str, Any]], seconds_left: int, used_characters: int) -> None:
    """Cut the lists about both parties so that they fit into two columns that share their room.

    Room that the lists leave goes first to the broken rules, then to the reasons, until all are printed. If other lines take more room,
    each list loses its share, the list of broken rules last.
    `seconds_left`: rows that the table second by second does not fill; `used_characters`: characters of other lines.
    """
    parts = [
        (told, name, min(_least(told[name], name), room))
        for name, room in _ROOM.items()
        for told in parties
        if name in told
    ]
    spare = _ALL_ROOM + _SECOND_ROOM * seconds_left - used_characters - sum(room for *_, room in parts)
    if spare < 0:
        parts = _shrunk(parts, -spare)
    rooms = [room for *_, room in parts]
    for first in _FIRST:
        for i, (told, name, room) in enumerate(parts):
            if name == first:
                more = min(_least(told[name], name) - room, max(spare, 0))
                rooms[i] += more
                spare -= more
    for (told, name, _), room in zip(parts, rooms, strict=True):
        fitting = _fitting_reasons if name == "reasons" else _fitting
        told[name] = fitting(told[name], name, room + max(spare, 0))
        spare -= max(_length(told[name].texts, name) + _TITLES_NOTE_CHARACTERS * told[name].is_short - room, 0)


def _shrunk(parts: Sequence[_Part], by: int) -> list[_Part]:
    """Take so many characters from the parts, in the order in which they give way; one reason of a party is printed in any case."""
    rooms = [room for *_, room in parts]
    for giving in ("excused", "kept", "reasons", "broken"):
        spared = {
            i: room - (min(_least(told[name][:1], name), room) if giving == "reasons" else 0)
            for i, (told, name, room) in enumerate(parts)
            if name == giving
        }
        held = sum(spared.values())
        taken = min(by, held)
        by -= taken
        for i, n in spared.items():
            rooms[i] -= taken * n // max(held, 1)
    return [(told, name, room) for (told, name, _), room in zip(parts, rooms, strict=True)]


def first_fitting(texts: Sequence[str], room: int) -> Fitting:
    """Return as many of some texts as fit into so many characters, at least one."""
    return _fitting(texts, "", room)


def _shortest(reasons: Sequence[Reason]) -> list[str]:
    return [min(reason.short, reason.full, key=len) for reason in reasons]


def _least(texts: Sequence[Any], part: str) -> int:
    """Return the least room that all texts of a part take, in characters."""
    if part != "reasons":
        return _length(texts, part)
    return min(_length([each.full for each in texts], part), _length(_shortest(texts), part) + _TITLES_NOTE_CHARACTERS)


def _length(texts: Sequence[str], part: str) -> int:
    """Return the room that texts of a part take, in characters."""
    return sum(len(text) + _WASTE.get(part, _JOIN) for text in texts)


def _fitting(texts: Sequence[str], part: str, room: int) -> Fitting:
    """Return as many of the texts as fit; at least one, except in parts of which only the number may be printed."""
    shown = list(texts[:1])
    if part in _MAY_GO and texts and room < len(texts[0]) // 2:
        return Fitting([], len(texts))
    for text in texts[1:]:
        if _length([*shown, text], part) > room:
            break
        shown.append(text)
    return Fitting(shown, len(texts) - len(shown))


def _fitting_reasons(reasons: Sequence[Reason], part: str, room: int) -> Fitting:
    """Return the reasons in full, or the longest lists of titles as numbers, until all fit; then as many as fit."""
    shown, shortest = [reason.full for reason in reasons], _shortest(reasons)
    if _length(shown, part) <= room:
        return Fitting(shown, 0)
    for i in sorted(range(len(shown)), key=lambda i: (len(shortest[i]) - len(shown[i]), i)):
        shown[i] = shortest[i]
        if _length(shown, part) + _TITLES_NOTE_CHARACTERS <= room:
            break
    fitting = _fitting(shown, part, room - _TITLES_NOTE_CHARACTERS)
    full = {reason.full for reason in reasons}
    return fitting._replace(is_short=any(text not in full for text in fitting.texts))
