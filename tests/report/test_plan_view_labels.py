"""Names in a picture: short ones all, of ids as long as those of data sets the beginnings of those concerned and of the nearest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.report.html import plan_view
from drivelint.result.text import brief_id

if TYPE_CHECKING:
    from drivelint.result.text import Row


def actors(*names: str) -> list[Row]:
    return [{"actor_id": name, "x_m": 5.0 * n, "y_m": 0.0} for n, name in enumerate(names)]


def test_short_names_are_all_shown() -> None:
    rows = actors("ego", *(f"car {n}" for n in range(20)))
    assert plan_view._actors_with_label(rows, rows[0], rows[3:4]) == rows
    assert brief_id("truck 12") == "truck 12"


def test_of_long_ids_those_concerned_and_the_nearest() -> None:
    rows = actors("ego", *(f"a34b697e-b881-471a-8da0-{n:012}" for n in range(20)))
    shown = plan_view._actors_with_label(rows, rows[0], rows[15:16])
    assert shown == [rows[0], rows[15], *rows[1:6]]
    assert brief_id(rows[1]["actor_id"]) == "a34b697e…"
