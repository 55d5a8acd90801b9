"""Signals and objects of the roads."""
from __future__ import annotations
from typing import Any
def furniture(net: Any, lanes: Any, offset: Any, quality: Any) -> dict[str, list[dict[str, Any]]]:
    return {t: [] for t in ("traffic_signal", "stop_line", "road_object", "crossing")}
