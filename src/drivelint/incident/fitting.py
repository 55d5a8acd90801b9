"""Fits the content into two pages. To save space, reasons lose the titles of their rules first; then whole reasons are left out.

Broken rules are never left out: if they do not fit into the two pages, further pages contain all that page 2 has no space for.
"""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from drivelint.phrases import plural

if TYPE_CHECKING:
    from collections.abc import Sequence

_RESERVED_CHARACTERS: Final = {"broken": 1500, "kept": 300, "excused": 80, "reasons": 350}
"""The characters reserved for each part; if page 2 has no space for some texts, it contains their number."""
_FIRST: Final = ("broken", "reasons")
"""Parts that get free space first, in this order."""
_MAY_GO: Final = frozenset({"kept", "excused"})
"""Parts that may be left out completely, because the party's first line contains their number."""
_EMPTY_LINE_END_CHARACTERS: Final = {"broken": 30}
"""The empty characters at the end of a text's last line, in parts in which each text begins a new line."""
_CHARACTERS_OF_ALL_PARTS: Final = 3100
"""The characters that all parts of both parties may take together; a part may use the space that others leave."""
_EXPLANATION_CHARACTERS: Final = 150
"""The characters of the sentences that explain the parts in `_MAY_GO`; they are left out with these parts."""
_CHARACTERS_OF_A_FURTHER_PAGE: Final = 8400
"""The characters that a page after page 2 has space for."""
_CHARACTERS_OF_A_HEADING: Final = 110
"""The characters that fit into the space of a heading on such a page."""
_CHARACTERS_PER_SECOND_ROW: Final = 120
"""The characters that fit into the space of one row of the table of seconds."""
_SEPARATOR_CHARACTERS: Final = 2
"""The number of characters between two texts."""
SHARED_HEAD: Final = 100
"""The characters of the heading of the reasons that both parties share, with the empty end of the line before."""
_TITLES_NOTE_CHARACTERS: Final = 80
"""The characters of the sentence that refers to the titles that were left out."""
_WIDE, _CELL, _FACT, _CHECK = 92, 39, 40, 88
"""The characters of a line in the widest possible font: across page 1, in a column of the parties or the facts, and beside a hash."""
_LINE_PX, _TEXT_PX = 13.6, 15.7
"""The height of a line in the tables of page 1, and in its first sentences."""
_FIRST_PX: Final = 440
"""The greatest height of the finding and the parties on page 1 that leaves enough space for the lists of missing records."""
_CHECK_LINE: Final = 125
"""The characters in the columns of page 2 that need as much space as one line of the hashes."""
_CELLS: Final = ("delta_v", "fastest", "lane", "lights")


_Part: TypeAlias = "tuple[dict[str, Any], str, int]"
"""The texts of a party by part, the name of one of the parts, and the characters that it may take."""


class Reason(NamedTuple):
    """Why some rules are not decided, and the titles of these rules."""

    why: str
    titles: tuple[str, ...]

    @property
    def full_text(self) -> str:
        """The reason, after the titles of its rules."""
        return f"{', '.join(self.titles)}: {self.why}"

    @property
    def short_text(self) -> str:
        """The reason with the number of its rules."""
        return f"{self.why} ({plural(len(self.titles), 'rule')})"


class Fitting(NamedTuple):
    """The texts that are printed, the number of texts that are left out, and whether a printed text is a short form."""

    texts: list[str]
    more: int
    is_short: bool = False


class Continuation(NamedTuple):
    """The texts of one part about one party, or about both, that page 2 has no space for."""

    party: dict[str, Any]
    part: str
    texts: list[str]


def is_crowded(page: dict[str, Any]) -> bool:
    """Return whether page 1 has no space for the lists of missing records. `page`: the values of `sheet.content`."""
    sure, rests, drive = page["sure"], page["rests"], page["drive"]
    facts = [
        8
        + _n_lines(
            f"{drive['map_name']} {page['road_id']} {page['place'].lanelet_id} {page['coordinates']} {page['hand']}",
            _FACT,
        ),
        10 + _n_lines(rests, _FACT) + _n_lines(sure["by"], _FACT),
    ]
    parties = page["parties"]
    rows = [[_n_lines(f"{p['kind']}, {p['size']} ({p['size_source']})", _CELL) for p in parties]]
    rows += [[_n_lines(p[name], _CELL) for p in parties] for name in _CELLS]
    rows += [[sum(_n_lines(each, _CELL) for each in p["slowed"]) or 1 for p in parties]]
    against = [page["against"] or "", page["least"] or "", *(f"contact also {each}" for each in page["contacts"].texts)]
    across = [page["story"], page["what"]]
    lines = max(facts) + sum(max(row) for row in rows) + _n_lines(" ".join(against), 2 * _CELL)
    lines += _n_lines(", ".join(page["drawn"]), _WIDE)
    return lines * _LINE_PX + sum(_n_lines(each, _WIDE) for each in across) * _TEXT_PX > _FIRST_PX


def check_room(texts: Sequence[str]) -> int:
    """Return the characters that the columns of page 2 lose because the lines with hashes (`texts`) wrap."""
    return _CHECK_LINE * sum(_n_lines(text, _CHECK) - 1 for text in texts)


def _n_lines(text: str, width: int) -> int:
    return len(wrap(text, width))


def shared_reasons(parties: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Remove the reasons that all parties share, with the same rules, from each party, and return these reasons."""
    given = [told["reasons"] for told in parties if "reasons" in told]
    shared = [reason for reason in given[0] if all(reason in others for others in given[1:])] if len(given) > 1 else []
    for told in parties:
        if "reasons" in told:
            told["reasons"] = [reason for reason in told["reasons"] if reason not in shared]
    return {"reasons": shared}


def fit(parties: Sequence[dict[str, Any]], seconds_left: int, used_characters: int) -> list[list[Continuation]]:
    """Cut the lists about both parties so that they fit into two columns with a common limit of characters, and return further pages.

    Free space goes first to the broken rules, then to the reasons, until all are printed. If other lines need space, the lists are
    shortened, the list of broken rules last. If a broken rule has no space, all texts without space are on the further pages.
    `seconds_left`: the unused rows of the table of seconds; `used_characters`: the characters of other lines.
    """
    lists = [(told, name, list(told[name])) for name in _RESERVED_CHARACTERS for told in parties if name in told]
    parts = [
        (told, name, min(_least(told[name], name), room))
        for name, room in _RESERVED_CHARACTERS.items()
        for told in parties
        if name in told
    ]
    spare = (
        _CHARACTERS_OF_ALL_PARTS
        + _CHARACTERS_PER_SECOND_ROW * seconds_left
        - used_characters
        - sum(room for *_, room in parts)
    )
    if spare + sum(room for _, name, room in parts if name in _MAY_GO) <= 0:
        spare = min(spare + _EXPLANATION_CHARACTERS, 0)
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
        spare -= max(_n_characters(told[name].texts, name) + _TITLES_NOTE_CHARACTERS * told[name].is_short - room, 0)
    if not any(told["broken"].more for told in parties if "broken" in told):
        return []
    return _further_pages([Continuation(told, name, _rest(texts, told[name])) for told, name, texts in lists])


def _rest(texts: Sequence[Any], fitting: Fitting) -> list[str]:
    """Return the texts of a part that page 2 does not contain, or contains only in a short form."""
    full = [text.full_text if isinstance(text, Reason) else text for text in texts]
    return [text for text in full if text not in fitting.texts]


def _further_pages(lists: Sequence[Continuation]) -> list[list[Continuation]]:
    """Distribute the lists over as many pages as they need; a list that goes on has a heading on each page."""
    pages: list[list[Continuation]] = []
    room = 0
    for told, part, texts in lists:
        on_page: Continuation | None = None
        for text in texts:
            needed = len(text) + _EMPTY_LINE_END_CHARACTERS["broken"]
            if needed + _CHARACTERS_OF_A_HEADING * (on_page is None) > room:
                pages.append([])
                room, on_page = _CHARACTERS_OF_A_FURTHER_PAGE, None
            if on_page is None:
                on_page = Continuation(told, part, [])
                pages[-1].append(on_page)
                room -= _CHARACTERS_OF_A_HEADING
            on_page.texts.append(text)
            room -= needed
    return pages


def _shrunk(parts: Sequence[_Part], by: int) -> list[_Part]:
    """Reduce the space of the parts by `by` characters, less important parts first; at least one reason per party remains."""
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
    """Return the first texts that fit into `room` characters together, at least one."""
    return _fitting(texts, "", room)


def _shortest(reasons: Sequence[Reason]) -> list[str]:
    return [min(reason.short_text, reason.full_text, key=len) for reason in reasons]


def _least(texts: Sequence[Any], part: str) -> int:
    """Return the characters that all texts of a part take, in their shortest forms."""
    if part != "reasons":
        return _n_characters(texts, part)
    return min(
        _n_characters([each.full_text for each in texts], part),
        _n_characters(_shortest(texts), part) + _TITLES_NOTE_CHARACTERS,
    )


def _n_characters(texts: Sequence[str], part: str) -> int:
    """Return the number of characters of texts of a part, with the space between them."""
    return sum(len(text) + _EMPTY_LINE_END_CHARACTERS.get(part, _SEPARATOR_CHARACTERS) for text in texts)


def _fitting(texts: Sequence[str], part: str, room: int) -> Fitting:
    """Return the first texts that fit; at least one, except for parts in `_MAY_GO`."""
    shown = list(texts[:1])
    if part in _MAY_GO and texts and room < len(texts[0]) // 2:
        return Fitting([], len(texts))
    for text in texts[1:]:
        if _n_characters([*shown, text], part) > room:
            break
        shown.append(text)
    return Fitting(shown, len(texts) - len(shown))


def _fitting_reasons(reasons: Sequence[Reason], part: str, room: int) -> Fitting:
    """Return the reasons that fit. Until all fit, the longest lists of titles are replaced by numbers, then reasons are left out."""
    shown, shortest = [reason.full_text for reason in reasons], _shortest(reasons)
    if _n_characters(shown, part) <= room:
        return Fitting(shown, 0)
    for i in sorted(range(len(shown)), key=lambda i: (len(shortest[i]) - len(shown[i]), i)):
        shown[i] = shortest[i]
        if _n_characters(shown, part) + _TITLES_NOTE_CHARACTERS <= room:
            break
    fitting = _fitting(shown, part, room - _TITLES_NOTE_CHARACTERS)
    full = {reason.full_text for reason in reasons}
    return fitting._replace(is_short=any(text not in full for text in fitting.texts))
