"""Collects the problems of a map while it is read."""

from __future__ import annotations

from collections import Counter
from typing import Any, Final

from drivelint.phrases import escape_invisible, name_list
from drivelint.sql.words import vocabularies

SIGNS_UNMAPPED_CHECK: Final = "signs_unmapped"
"""The id of the check for a map without stop and give-way signs, even if they exist on the road."""
_EFFECTS_OF_UNKNOWN_WORDS: Final = {
    "lane_type": ("warning", "types of lanes", "vehicles are assumed not to drive there"),
    "road_type": ("info", "types of roads", "treated as not stated"),
    "marking": ("info", "road marks", "whether they may be crossed is not known"),
    "marking_color": ("info", "colors of road marks", "treated as not stated"),
    "lanes_changed": ("info", "lane changes over road marks", "treated as not stated"),
}
"""Vocabulary -> severity, the subject of its words, and the effect of an unknown word."""
_NETCONVERT_PLACEHOLDER_LIMIT_MPS: Final = 39.44
"""The limit (142 km/h) that SUMO's netconvert 1.28 writes for roads with `maxspeed=none`, and for motorways without a limit."""
_ORDER = {"error": 0, "warning": 1, "info": 2}


class MapQuality:
    """Collects the rows of `map_quality`."""

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []
        self._unknown_words: dict[str, Counter[str]] = {name: Counter() for name in _EFFECTS_OF_UNKNOWN_WORDS}
        self._stand_ins = 0
        self._n_sections_under_wrong_side = 0

    def limit_unless_placeholder(self, limit_mps: float) -> float | None:
        """Return a speed limit (m/s) of the map; None, and count it, if it is netconvert's placeholder for a missing limit."""
        if abs(limit_mps - _NETCONVERT_PLACEHOLDER_LIMIT_MPS) > 1e-9:
            return limit_mps
        self._stand_ins += 1
        return None

    def count_section_under_wrong_side(self) -> None:
        """Count an OpenDRIVE lane section whose lanes are all under `<left>` or all under `<right>`, with numbers of the other side."""
        self._n_sections_under_wrong_side += 1

    def known_word(self, vocabulary: str, word: str) -> str | None:
        """Return a word of the map in the vocabulary's spelling, whatever its case; None, and count it, if it is unknown."""
        spelling = vocabularies()[vocabulary].known_spelling(word)
        if spelling is None:
            self._unknown_words[vocabulary][word] += 1
        return spelling

    def add(self, check: str, severity: str, lanelet: str | None, message: str, n: int = 1) -> None:
        """Add a row; `lanelet`: the lanelet or road concerned, None: the whole map."""
        assert severity in _ORDER, severity  # noqa: S101 - a programming error
        self.rows.append(_quality_row(check, severity, lanelet, message, n))

    def add_unusable_geo_reference(self, reference: str, why: object) -> None:
        """Add a row on why the map's geo reference gives no positions on the earth."""
        message = f"the geo reference {reference!r} gives no positions on the earth: {why}"
        self.add("geo_reference_unusable", "info", None, message)

    def sorted_rows(self) -> list[dict[str, Any]]:
        """Return the rows, the most severe first, including one for each kind of counted problem."""
        rows = list(self.rows)
        for vocabulary, words in self._unknown_words.items():
            severity, subject, follows = _EFFECTS_OF_UNKNOWN_WORDS[vocabulary]
            names = name_list([f"{escape_invisible(word[:40])} ({n})" for word, n in sorted(words.items())])
            message = f"{subject} with unknown names: {names}: {follows}"
            if words:
                rows.append(_quality_row("unknown_word", severity, None, message, words.total()))
        if self._stand_ins:
            message = (
                f"{_NETCONVERT_PLACEHOLDER_LIMIT_MPS:g} m/s is the value that netconvert writes for a road without a "
                "limit: the limit is treated as unknown"
            )
            rows.append(_quality_row("invalid_speed", "warning", None, message, self._stand_ins))
        if self._n_sections_under_wrong_side:
            message = "lane sections list lanes under <left> or <right> whose numbers belong to the other side: the numbers are used"
            rows.append(_quality_row("lane_side", "info", None, message, self._n_sections_under_wrong_side))
        return sorted(rows, key=lambda r: (_ORDER[r["severity"]], r["check_id"], r["lanelet_id"] or "", r["message"]))


def _quality_row(check: str, severity: str, lanelet: str | None, message: str, n: int) -> dict[str, Any]:
    return {"check_id": check, "severity": severity, "lanelet_id": lanelet, "n": n, "message": message}
