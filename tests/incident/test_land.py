"""A place far out at sea is doubted on the sheet; a place on land or near a coast is not."""

from __future__ import annotations

import pytest

from drivelint.incident.land import is_far_at_sea
from drivelint.incident.place import Place, doubtful_at_sea_text

LAND = {
    "Bristol": (51.489, -2.5),
    "Shropshire": (52.947, -2.907),
    "Miami": (25.76, -80.19),
    "Key West": (24.55, -81.8),
    "Malé": (4.175, 73.51),
    "Singapore": (1.3, 103.8),
    "the Channel Tunnel": (51.0, 1.45),
    "Wellington": (-41.29, 174.78),
    "Suva, near the date line": (-18.14, 178.44),
    "the poles' edge": (-90.0, 180.0),
}
SEA = {
    "the North Sea": (52.947, 2.907),
    "the Atlantic": (30.0, -40.0),
    "the Gulf of Guinea": (0.1, 4.5),
    "the South Pacific": (-50.0, -120.0),
    "the North Pole": (90.0, 180.0),
}


@pytest.mark.parametrize("name", LAND)
def test_land_is_not_doubted(name: str) -> None:
    assert not is_far_at_sea(*LAND[name])
    assert doubtful_at_sea_text(Place(0, *LAND[name], None, None, None), "map") == ""


@pytest.mark.parametrize("name", SEA)
def test_a_place_at_sea_is_doubted(name: str) -> None:
    assert is_far_at_sea(*SEA[name])
    assert "the map's geo reference, doubtful: in the sea" in doubtful_at_sea_text(
        Place(0, *SEA[name], None, None, None), "map"
    )


def test_an_unknown_place_is_not_doubted() -> None:
    assert doubtful_at_sea_text(Place(0, None, None, 1.0, 2.0, None), "log") == ""
