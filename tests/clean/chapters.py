"""The chapters by name: what the ego meets there, and how it behaves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.clean import country, junctions, motorways, streets

if TYPE_CHECKING:
    from collections.abc import Callable

CHAPTERS: dict[str, Callable[..., None]] = {
    chapter.__name__: chapter
    for chapter in (
        *(country.follow, country.overtake, country.overtaken),
        *(streets.cyclist, streets.zebra, streets.pelican, streets.queue, streets.parked, streets.cut_in),
        *(junctions.stop_sign, junctions.offside_turn, junctions.nearside_turn, junctions.light),
        *(motorways.motorway, motorways.jam, motorways.convoy),
    )
}
