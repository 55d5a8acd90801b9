"""Places across the road, speeds and plans that are in many scenes."""

from __future__ import annotations

from tests.outsiders.fourth.movement import KMH

F, M = -1.875, -5.625  # centres of the fast lane and the lane beside it on a motorway
L = -1.75  # centre of the own lane on a road of 3.5 m lanes
ON = ((0.0, "engaged", "on"),)
ALWAYS_UNKNOWN = ((0.0, 99.0, "unknown"),)
V130, V100, V50 = 130 * KMH, 100 * KMH, 50 * KMH
GENTLE: list[float | tuple[float, float]] = [4.0, (12.0, 1.2), 3.0, (20.0, 1.2)]
