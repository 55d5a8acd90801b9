"""Every section runs, as small as can be: no benchmark rots, and no time is asserted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import tests.bench
from tests.bench import stages
from tests.bench.__main__ import SECTIONS, main
from tests.bench.clock import Span, Stages, now
from tests.bench.place import TINY, Place
from tests.bench.table import Bar, Row, Skipped, markdown

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("section", SECTIONS)
def test_a_section_measures_something(section: str, tmp_path: Path) -> None:
    try:
        rows = SECTIONS[section](Place(tmp_path, TINY))
    except Skipped as why:
        pytest.skip(f"{section}: {why}")
    assert rows
    assert all(row.value > 0 for row in rows if row.bar)
    assert markdown(rows).count("\n") == len(rows) + 1


def test_every_stage_of_the_reference_drive_takes_time(tmp_path: Path) -> None:
    """A stage whose function was renamed would take none."""
    place = Place(tmp_path, TINY)
    spent = stages.check([str(place.reference)], place.road, tmp_path / "out")
    assert [stage for stage, took in spent.items() if took.wall <= 0] == []


def test_the_command_prints_the_table(capsys: pytest.CaptureFixture[str]) -> None:
    main(["--tiny", "shapely"])
    assert "| shapely | all pairs: ours is faster |" in capsys.readouterr().out


def test_an_unknown_section_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["shapley"])
    assert "no section 'shapley'" in capsys.readouterr().err


@pytest.mark.parametrize(("value", "bar", "word"), [(2.0, Bar(2.0), "met"), (2.0, Bar(3.0, at_least=True), "missed")])
def test_a_bar_is_met_or_missed(value: float, bar: Bar, word: str) -> None:
    assert word in markdown([Row("s", "w", value, bar=bar)]).splitlines()[-1]


class _Work:
    def outer(self) -> float:
        return self.inner()

    def inner(self) -> float:
        begin = now()
        while (now() - begin).wall < 0.01:
            pass
        return 1.0


def test_a_stage_does_not_count_the_stages_within() -> None:
    stages, work = Stages(), _Work()
    with stages.watch((_Work, "outer", "outer"), (_Work, "inner", "inner")):
        work.outer()
    assert stages.spent["inner"].wall >= 0.01
    assert Span() <= stages.spent["outer"] < stages.spent["inner"]
    assert _Work.outer.__name__ == "outer"


def test_a_module_is_not_watched_as_a_function() -> None:
    with (
        pytest.raises(TypeError, match=r"tests\.bench\.growth is no function"),
        Stages().watch((tests.bench, "growth", "b")),
    ):
        pass
