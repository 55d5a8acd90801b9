"""The CommonRoad scenarios that both sides read, and twins of them whose lanes have a speed limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from tests.shared_data import DATA

if TYPE_CHECKING:
    from pathlib import Path

LIMITS_KMH = (60, 120)
"""One is exceeded in the recordings, and one is far from being reached."""
SIGN_ID = 990001


def public_scenarios() -> list[Path]:
    """Return the scenarios beside the checkout."""
    return sorted((DATA / "commonroad").glob("*.xml"))


def scenario_kinds(scenario: Path) -> tuple[str, ...]:
    """Return the peer's kinds of a scenario: every one is judged as a motorway, and one that has an intersection as such, too."""
    has_intersection = etree.parse(scenario).getroot().find("intersection") is not None
    return ("interstate", "intersection") if has_intersection else ("interstate",)


def with_speed_limit(scenario: Path, limit_kmh: int, folder: Path) -> Path | None:
    """Write a scenario again, with one German speed limit for all lanes; None if it has signs or is older than 2020a.

    A recording without signs tells nothing about rules that need a limit. The name of the country goes into the scenario's id, too: it
    says how both sides read the number of a sign.
    """
    tree = etree.parse(scenario)
    root = tree.getroot()
    if root.get("commonRoadVersion") != "2020a" or root.find("trafficSign") is not None:
        return None
    root.set("benchmarkID", "DEU" + root.get("benchmarkID", "")[3:])
    lanelets = root.findall("lanelet")
    for lanelet in lanelets:
        etree.SubElement(lanelet, "trafficSignRef", ref=str(SIGN_ID))
    sign = etree.Element("trafficSign", id=str(SIGN_ID))
    element = etree.SubElement(sign, "trafficSignElement")
    etree.SubElement(element, "trafficSignID").text = "274"
    etree.SubElement(element, "additionalValue").text = f"{limit_kmh / 3.6:.4f}"
    etree.SubElement(sign, "virtual").text = "true"
    lanelets[-1].addnext(sign)
    path = folder / f"{scenario.stem}+{limit_kmh}.xml"
    tree.write(path, xml_declaration=True, encoding="utf-8")
    return path
