"""What is wrong with a map, collected while it is read."""

from __future__ import annotations

from typing import Any, Final

SIGNS_UNMAPPED: Final = "signs_unmapped"
"""The check of a map that has no stop and give-way signs, whether they stand there or not."""
_ORDER = {"error": 0, "warning": 1, "info": 2}


class MapQuality:
    """Collects the rows of `map_quality`."""

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []

    def add(self, check: str, severity: str, lanelet: str | None, message: str, n: int = 1) -> None:
        """Add a row; `lanelet` is the lanelet or road concerned, None the whole map."""
        assert severity in _ORDER, severity  # noqa: S101 - a mistake of ours
        self.rows.append({"check_id": check, "severity": severity, "lanelet_id": lanelet, "n": n, "message": message})

    def geo_unusable(self, reference: str, why: object) -> None:
        """Say that the map has a geo reference, and why it gives no positions on the earth."""
        message = f"the geo reference {reference!r} gives no positions on the earth: {why}"
        self.add("geo_reference_unusable", "info", None, message)

    def sorted_rows(self) -> list[dict[str, Any]]:
        """Return the rows, the most severe first."""
        return sorted(
            self.rows, key=lambda r: (_ORDER[r["severity"]], r["check_id"], r["lanelet_id"] or "", r["message"])
        )
