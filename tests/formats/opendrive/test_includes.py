"""A map of which a part is in another file is refused: without that part, signs and roads would be missing."""

from __future__ import annotations

import pytest

from drivelint.errors import MapError
from tests.formats.maps import lanelets
from tests.formats.opendrive.xodr import lane, load, road, section


def with_include(place: str, element: str) -> tuple[str, ...]:
    """Return the parts of a map with an element in a place."""
    if place == "file":
        return road(), element
    if place == "signals":
        return (road(more=f"<signals>{element}</signals>"),)
    if place == "lane":
        return (road(lanes=section(0, lane(-1, f'<width sOffset="0" a="3.5"/>{element}'))),)
    return (road(more=f"<userData>{element}</userData>"),)


@pytest.mark.parametrize("place", ["file", "signals", "lane"])
def test_a_map_that_includes_a_file_is_refused(place: str) -> None:
    refusal = r"^map small\.xodr includes another file in line 1, which is not read \(signs\.xml\): replace <include> by .* file$"
    with pytest.raises(MapError, match=refusal):
        load(*with_include(place, '<include file="signs.xml"/>'))


def test_the_name_of_the_included_file_is_printable() -> None:
    with pytest.raises(MapError, match=r"\(\\u202egpj\)"):
        load(*with_include("file", '<include file="\u202egpj"/>'))
    with pytest.raises(MapError, match=r"\(without a name\)"):
        load(*with_include("file", "<include/>"))


def test_what_applications_add_is_no_part_of_the_map() -> None:
    assert len(lanelets(load(*with_include("userData", '<include file="trees.xml"/>')))) == 2
