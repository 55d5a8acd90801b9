"""The country in the name of a CommonRoad scenario: DEU_Moelln-10_2_T-1 is in Germany; ZAM stands for no country."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lxml import etree


def country_in_scenario_name(root: etree._Element) -> str:
    """Return the three letters of the country in the scenario's name; ZAM stands for no country."""
    return (root.get("benchmarkID") or "").removeprefix("C-")[:3].upper()
