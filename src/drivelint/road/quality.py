"""What is wrong with a map, collected while it is read."""

from __future__ import annotations

from typing import Any

_ORDER = {"error": 0, "warning": 1, "info": 2}


class MapQuality:
    """Collects the rows of `map_quality`."""

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []

    def add(self, check: str, severity: str, lanelet: str | None, message: str, n: int = 1) -> None:
        """Add a row; `lanelet` is the lanelet or road concerned, None the whole map."""
        assert severity in _ORDER, severity  # noqa: S101 - a mistake of ours
        self.rows.append({"check_id": check, "severity": severity, "lanelet_id": lanelet, "n": n, "message": message})

    def sorted_rows(self) -> list[dict[str, Any]]:
        """Return the rows, the most severe first."""
        return sorted(
            self.rows, key=lambda r: (_ORDER[r["severity"]], r["check_id"], r["lanelet_id"] or "", r["message"])
        )
