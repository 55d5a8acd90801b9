"""Fits the content into two pages. To save space, reasons lose the titles of their rules first; then whole reasons are left out.

Broken rules are never left out: if they do not fit into the two pages, further pages contain all that page 2 has no space for.
"""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any, Final, NamedTuple, TypeAlias

from drivelint.phrases import plural

if TYPE_CHECKING:
    from collections.abc import Sequence

_RESERVED_CHARACTERS_BY_PART: Final = {"broken": 1500, "kept": 300, "excused": 80, "reasons": 350}
"""The characters reserved for each part; if page 2 has no space for some texts, it contains their number."""
_PARTS_THAT_GET_FREE_SPACE_FIRST: Final = ("broken", "reasons")
"""Parts that get free space first, in this order."""
_OMISSIBLE_PARTS: Final = frozenset({"kept", "excused"})
"""Parts that may be left out completely, because the party's first line contains their number."""
_UNUSED_LINE_END_CHARACTERS_BY_PART: Final = {"broken": 30}
"""The empty characters at the end of a text's last line, in parts in which each text begins a new line."""
_MOST_CHARACTERS_OF_ALL_PARTS: Final = 3100
"""The characters that all parts of both parties may take together; a part may use the space that others leave."""
_EXPLANATION_CHARACTERS: Final = 150
"""The characters of the sentences that explain the parts in `_OMISSIBLE_PARTS`; they are left out with these parts."""
_CHARACTERS_OF_A_FURTHER_PAGE: Final = 8400
"""The characters that a page after page 2 has space for."""
_CHARACTERS_OF_A_HEADING: Final = 110
"""The characters that fit into the space of a heading on such a page."""
_CHARACTERS_IN_SPACE_OF_SECONDS_ROW: Final = 120
"""The characters that fit into the space of one row of the table of seconds."""
_SEPARATOR_CHARACTERS: Final = 2
"""The number of characters between two texts."""
SHARED_HEADING_CHARACTERS: Final = 100
"""The characters of the heading of the reasons that both parties share, with the empty end of the line before."""
_TITLES_NOTE_CHARACTERS: Final = 80
"""The characters of the sentence that refers to the titles that were left out."""
_PAGE_LINE_CHARACTERS, _PARTY_LINE_CHARACTERS, _FACT_LINE_CHARACTERS, _HASH_LINE_CHARACTERS = 92, 39, 40, 88
"""The characters of a line in the widest possible font: across page 1, in a column of the parties or the facts, and beside a hash."""
_TABLE_LINE_PX, _SENTENCE_LINE_PX = 13.6, 15.7
"""The height of a line in the tables of page 1, and in its first sentences."""
_LARGEST_HEIGHT_OF_TABLES_PX: Final = 440
"""The greatest height of the finding and the parties on page 1 that leaves enough space for the lists of missing records."""
_CHARACTERS_IN_SPACE_OF_HASH_LINE: Final = 125
"""The characters in the columns of page 2 that need as much space as one line of the hashes."""
_PARTY_CELL_KEYS: Final = ("delta_v", "fastest", "lane", "lights")


_PartWithRoom: TypeAlias = "tuple[dict[str, Any], str, int]"
"""The texts of a party by part, the name of one of the parts, and the characters that it may take."""


class UndecidedReason(NamedTuple):
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


class FittedTexts(NamedTuple):
    """The texts that are printed, the number of texts that are left out, and whether a printed text is a short form."""

    texts: list[str]
    more: int
    is_short: bool = False


class ContinuedTexts(NamedTuple):
    """The texts of one part about one party, or about both, that page 2 has no space for."""

    party: dict[str, Any]
    part: str
    texts: list[str]


def is_first_page_full(sheet_values: dict[str, Any]) -> bool:
    """Return whether page 1 has no space for the lists of missing records. `sheet_values`: the values of `sheet.template_values`."""
    sure, rests, drive = sheet_values["sure"], sheet_values["rests"], sheet_values["drive"]
    facts = [
        8
        + _n_wrapped_lines(sheet_values["simulator"], _FACT_LINE_CHARACTERS)
        + _n_wrapped_lines(
            f"{drive['map_name']} {sheet_values['road_id']} {sheet_values['place'].lanelet_id} "
            f"{sheet_values['coordinates']} {sheet_values['hand']}",
            _FACT_LINE_CHARACTERS,
        ),
        10 + _n_wrapped_lines(rests, _FACT_LINE_CHARACTERS) + _n_wrapped_lines(sure["by"], _FACT_LINE_CHARACTERS),
    ]
    parties = sheet_values["parties"]
    rows = [
        [_n_wrapped_lines(f"{p['kind']}, {p['size']} ({p['size_source']})", _PARTY_LINE_CHARACTERS) for p in parties]
    ]
    rows += [[_n_wrapped_lines(p[name], _PARTY_LINE_CHARACTERS) for p in parties] for name in _PARTY_CELL_KEYS]
    rows += [[sum(_n_wrapped_lines(text, _PARTY_LINE_CHARACTERS) for text in p["slowed"]) or 1 for p in parties]]
    against = [
        sheet_values["against"] or "",
        sheet_values["least"] or "",
        *(f"contact also {text}" for text in sheet_values["contacts"].texts),
    ]
    across = [sheet_values["story"], sheet_values["what"]]
    lines = max(facts) + sum(max(row) for row in rows) + _n_wrapped_lines(" ".join(against), 2 * _PARTY_LINE_CHARACTERS)
    lines += _n_wrapped_lines(", ".join(sheet_values["drawn"]), _PAGE_LINE_CHARACTERS)
    return (
        lines * _TABLE_LINE_PX
        + sum(_n_wrapped_lines(text, _PAGE_LINE_CHARACTERS) for text in across) * _SENTENCE_LINE_PX
        > _LARGEST_HEIGHT_OF_TABLES_PX
    )


def characters_lost_to_hash_lines(texts: Sequence[str]) -> int:
    """Return the characters that the columns of page 2 lose because the lines with hashes (`texts`) wrap."""
    return _CHARACTERS_IN_SPACE_OF_HASH_LINE * sum(_n_wrapped_lines(text, _HASH_LINE_CHARACTERS) - 1 for text in texts)


def _n_wrapped_lines(text: str, width: int) -> int:
    return len(wrap(text, width))


def remove_and_return_shared_reasons(parties: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Remove the reasons that all parties share, with the same rules, from each party, and return these reasons."""
    lists = [party["reasons"] for party in parties if "reasons" in party]
    shared = (
        [reason for reason in lists[0] if all(reason in reasons for reasons in lists[1:])] if len(lists) > 1 else []
    )
    for party in parties:
        if "reasons" in party:
            party["reasons"] = [reason for reason in party["reasons"] if reason not in shared]
    return {"reasons": shared}


def fit_conduct_lists_and_return_further_pages(
    parties: Sequence[dict[str, Any]], unused_rows_of_seconds: int, used_characters: int
) -> list[list[ContinuedTexts]]:
    """Cut the lists about both parties so that they fit into two columns with a common limit of characters, and return further pages.

    Free space goes first to the broken rules, then to the reasons, until all are printed, then to the titles of rules in the reasons. If
    other lines need space, the lists are shortened, the list of broken rules last. If a broken rule has no space, all texts without space
    are on the further pages.
    `unused_rows_of_seconds`: the unused rows of the table of seconds; `used_characters`: the characters of other lines.
    """
    lists = [
        (party, name, list(party[name])) for name in _RESERVED_CHARACTERS_BY_PART for party in parties if name in party
    ]
    parts = [
        (party, name, min(_least_characters(party[name], name), room))
        for name, room in _RESERVED_CHARACTERS_BY_PART.items()
        for party in parties
        if name in party
    ]
    spare = (
        _MOST_CHARACTERS_OF_ALL_PARTS
        + _CHARACTERS_IN_SPACE_OF_SECONDS_ROW * unused_rows_of_seconds
        - used_characters
        - sum(room for *_, room in parts)
    )
    if spare + sum(room for _, name, room in parts if name in _OMISSIBLE_PARTS) <= 0:
        spare = min(spare + _EXPLANATION_CHARACTERS, 0)
    if spare < 0:
        parts = _parts_with_less_space(parts, -spare)
    rooms = [room for *_, room in parts]
    for wanted_characters in (_least_characters, _full_characters):
        for first in _PARTS_THAT_GET_FREE_SPACE_FIRST:
            for i, (party, name, _) in enumerate(parts):
                if name == first:
                    more = min(max(wanted_characters(party[name], name) - rooms[i], 0), max(spare, 0))
                    rooms[i] += more
                    spare -= more
    for (party, name, _), room in zip(parts, rooms, strict=True):
        fitting = _fitted_reasons if name == "reasons" else _fitted_texts_of_part
        party[name] = fitting(party[name], name, room + max(spare, 0))
        spare -= max(_n_characters(party[name].texts, name) + _TITLES_NOTE_CHARACTERS * party[name].is_short - room, 0)
    if not any(party["broken"].more for party in parties if "broken" in party):
        return []
    return _further_pages(
        [ContinuedTexts(party, name, _texts_that_do_not_fit(texts, party[name])) for party, name, texts in lists]
    )


def _texts_that_do_not_fit(texts: Sequence[Any], fitting: FittedTexts) -> list[str]:
    """Return the texts of a part that page 2 does not contain, or contains only in a short form."""
    full = [text.full_text if isinstance(text, UndecidedReason) else text for text in texts]
    return [text for text in full if text not in fitting.texts]


def _further_pages(lists: Sequence[ContinuedTexts]) -> list[list[ContinuedTexts]]:
    """Distribute the lists over as many pages as they need; a list that goes on has a heading on each page."""
    pages: list[list[ContinuedTexts]] = []
    room = 0
    for party, part, texts in lists:
        on_page: ContinuedTexts | None = None
        for text in texts:
            text_characters = len(text) + _UNUSED_LINE_END_CHARACTERS_BY_PART["broken"]
            if text_characters + _CHARACTERS_OF_A_HEADING * (on_page is None) > room:
                pages.append([])
                room, on_page = _CHARACTERS_OF_A_FURTHER_PAGE, None
            if on_page is None:
                on_page = ContinuedTexts(party, part, [])
                pages[-1].append(on_page)
                room -= _CHARACTERS_OF_A_HEADING
            on_page.texts.append(text)
            room -= text_characters
    return pages


def _parts_with_less_space(parts: Sequence[_PartWithRoom], by_characters: int) -> list[_PartWithRoom]:
    """Reduce the space of the parts by `by_characters` characters, less important parts first; at least one reason per party remains."""
    rooms = [room for *_, room in parts]
    for giving in ("excused", "kept", "reasons", "broken"):
        spared = {
            i: room - (min(_least_characters(party[name][:1], name), room) if giving == "reasons" else 0)
            for i, (party, name, room) in enumerate(parts)
            if name == giving
        }
        n_spared = sum(spared.values())
        n_taken = min(by_characters, n_spared)
        by_characters -= n_taken
        for i, n in spared.items():
            rooms[i] -= n_taken * n // max(n_spared, 1)
    return [(party, name, room) for (party, name, _), room in zip(parts, rooms, strict=True)]


def first_fitted_texts(texts: Sequence[str], max_characters: int) -> FittedTexts:
    """Return the first texts that fit into `max_characters` characters together, at least one."""
    return _fitted_texts_of_part(texts, "", max_characters)


def _shortest_reason_texts(reasons: Sequence[UndecidedReason]) -> list[str]:
    return [min(reason.short_text, reason.full_text, key=len) for reason in reasons]


def _least_characters(texts: Sequence[Any], part: str) -> int:
    """Return the characters that all texts of a part take, in their shortest forms."""
    if part != "reasons":
        return _n_characters(texts, part)
    return min(
        _n_characters([reason.full_text for reason in texts], part),
        _n_characters(_shortest_reason_texts(texts), part) + _TITLES_NOTE_CHARACTERS,
    )


def _full_characters(texts: Sequence[Any], part: str) -> int:
    """Return the characters that all texts of a part take, with the titles of all rules."""
    return _n_characters([reason.full_text for reason in texts] if part == "reasons" else texts, part)


def _n_characters(texts: Sequence[str], part: str) -> int:
    """Return the number of characters of texts of a part, with the space between them."""
    return sum(len(text) + _UNUSED_LINE_END_CHARACTERS_BY_PART.get(part, _SEPARATOR_CHARACTERS) for text in texts)


def _fitted_texts_of_part(texts: Sequence[str], part: str, max_characters: int) -> FittedTexts:
    """Return the first texts that fit; at least one, except for parts in `_OMISSIBLE_PARTS`."""
    fitting_texts = list(texts[:1])
    if part in _OMISSIBLE_PARTS and texts and max_characters < len(texts[0]) // 2:
        return FittedTexts([], len(texts))
    for text in texts[1:]:
        if _n_characters([*fitting_texts, text], part) > max_characters:
            break
        fitting_texts.append(text)
    return FittedTexts(fitting_texts, len(texts) - len(fitting_texts))


def _fitted_reasons(reasons: Sequence[UndecidedReason], part: str, max_characters: int) -> FittedTexts:
    """Return the reasons that fit. Until all fit, the longest lists of titles are replaced by numbers, then reasons are left out."""
    texts, shortest = [reason.full_text for reason in reasons], _shortest_reason_texts(reasons)
    if _n_characters(texts, part) <= max_characters:
        return FittedTexts(texts, 0)
    for i in sorted(range(len(texts)), key=lambda i: (len(shortest[i]) - len(texts[i]), i)):
        texts[i] = shortest[i]
        if _n_characters(texts, part) + _TITLES_NOTE_CHARACTERS <= max_characters:
            break
    fitting = _fitted_texts_of_part(texts, part, max_characters - _TITLES_NOTE_CHARACTERS)
    full = {reason.full_text for reason in reasons}
    return fitting._replace(is_short=any(text not in full for text in fitting.texts))
