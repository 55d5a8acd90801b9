"""Every section runs, as small as can be: no benchmark rots, and no time is asserted."""

from __future__ import annotations

import subprocess
import sys
from collections import Counter
from importlib.metadata import version
from pathlib import Path

import pyarrow.parquet as pq
import pytest

import tests.bench
from tests.bench import before, commit, stages
from tests.bench.__main__ import SECTIONS, main
from tests.bench.clock import Span, Stages, now
from tests.bench.place import TINY, Place
from tests.bench.table import Bar, Row, Skipped, markdown
from tests.bench.timed_check import Job, StageError, Timed, owner_of, timed_check
from tests.shared_data import ROOT

STAGES = ["ingest", "map", "derive", "rules", "the rest", "to the verdict tables"]


@pytest.mark.slow
@pytest.mark.parametrize("section", [section for section in SECTIONS if section != "before"])
def test_a_section_measures_something(section: str, tmp_path: Path) -> None:
    try:
        rows = SECTIONS[section](Place(tmp_path, TINY))
    except Skipped as why:
        pytest.skip(f"{section}: {why}")
    assert rows
    assert all(row.value > 0 for row in rows if row.bar)
    assert markdown(rows).count("\n") == len(rows) + 1


@pytest.mark.slow
def test_every_stage_takes_time(tmp_path: Path) -> None:
    """A stage whose function was renamed would take none. A drive with findings, so that there is something to copy."""
    scenes = ROOT / "fixtures" / "scenes"
    spent = stages.check([str(scenes / "collision.mcap")], scenes / "overtake-road.xodr", tmp_path / "out")
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
        pytest.raises(TypeError, match=r"tests\.bench\.before is no function"),
        Stages().watch((tests.bench, "before", "b")),
    ):
        pass


@pytest.mark.slow
def test_head_against_the_present_tree(tmp_path: Path) -> None:
    try:
        first, *rows = SECTIONS["before"](Place(tmp_path, TINY))
    except Skipped as why:
        pytest.skip(f"before: {why}")
    assert "in the present environment" in first.note
    by_input: dict[str, list[Row]] = {}
    for row in rows:
        by_input.setdefault(row.section.split(", ", 1)[1], []).append(row)
    assert list(by_input)[:2] == ["reference drive", "3 short drives"]
    assert {tuple(row.label for row in each) for each in by_input.values()} == {(*STAGES, "verdicts")}
    assert all(row.value > 0 for row in rows)
    told = [each[-1].note.removeprefix("now ").split("; before ") for each in by_input.values()]
    assert told[0][0] == _counts_of_command(Place(tmp_path, TINY), tmp_path / "own")
    # a rule that is worked on may give other verdicts than that of HEAD
    if not commit._git("status", "--porcelain", "src", "schemas", "queries"):
        assert [now for now, _ in told] == [then for _, then in told]


def _counts_of_command(place: Place, out: Path) -> str:
    """Count the verdicts of the reference drive in the table that the command writes."""
    command = ["check", str(place.reference), "--map", str(place.road), "--out", str(out), "--rules", "ukhc"]
    subprocess.run([sys.executable, "-m", "drivelint", *command, "--fail-on", "never"], check=True, capture_output=True)
    verdicts = Counter(pq.read_table(out / "verdicts.parquet")["verdict"].to_pylist())
    return ", ".join(f"{n} {verdict}" for verdict, n in sorted(verdicts.items()))


@pytest.mark.slow
def test_the_stages_of_an_old_commit_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its modules and functions have other names than now."""
    monkeypatch.setattr(
        commit, "_environment", lambda *_: pytest.skip("before: d1ebcd6 needs an environment of its own")
    )
    place = Place(tmp_path, TINY)
    try:
        tree = commit.unpacked("d1ebcd6", tmp_path)
    except (Skipped, commit.UnknownCommitError) as why:
        pytest.skip(f"before: {why}")
    timed = before._timed(tree, before.Input("reference drive", place.reference, place.road), tmp_path)
    assert list(timed.spent) == STAGES
    assert all(spent.cpu > 0 for spent in timed.spent.values())
    assert timed.verdicts["pass"] > 0


def test_a_ratio_is_of_the_medians_of_now_and_before() -> None:
    def timed(cpu: float, wall: float, fails: int) -> Timed:
        return Timed({"derive": Span(wall, cpu)}, {"pass": 3, "fail": fails})

    taken = {"now": [timed(1, 9, 0), timed(9, 3, 0), timed(2, 1, 0)], "before": [timed(n, 2, 3) for n in (4, 1, 9)]}
    derive, verdicts = before._compared("old", taken)
    assert (derive.label, derive.value, derive.unit, derive.cpu) == ("derive", 0.5, "x", 2)
    assert derive.note == "CPU 4.00 s before; wall 3.00 s, before 2.00 s: 1.50 x"
    assert (verdicts.value, verdicts.note) == (0.5, "now 0 fail, 3 pass; before 3 fail, 3 pass")


def test_a_stage_without_a_function_is_named() -> None:
    with pytest.raises(
        StageError, match=r"no function for 'derive': none of drivelint\.gone\.derive, drivelint\.run\.gone"
    ):
        # a package or module of the name is no function
        owner_of("derive", (("drivelint.gone", "derive"), ("drivelint.run", "gone"), ("drivelint", "engine")))


def test_the_newest_name_is_taken() -> None:
    assert owner_of("x", (("gone", "x"), ("pathlib", "Path.cwd"), ("pathlib", "Path.home"))) == (Path, "cwd")


@pytest.mark.ci
def test_a_stage_that_was_never_called_is_named(tmp_path: Path) -> None:
    place = Place(tmp_path, TINY)
    job = Job("", "", str(tmp_path / "out"), [str(place.reference)], str(place.road), ["ukhc.no-collision"], None)
    # there are no annotated logs
    with pytest.raises(StageError, match=r"the function of 'drawn', Annotator\.__call__, was never called"):
        timed_check(job, (("drawn", (("drivelint.annotate", "Annotator.__call__"),)),))


def test_a_process_that_imports_another_tree_is_refused(tmp_path: Path) -> None:
    tree = commit.Tree("empty", tmp_path / "empty", Path(sys.executable))
    with pytest.raises(RuntimeError, match=r"empty, log: .*drivelint"):
        before._timed(tree, before.Input("log", tmp_path, None), tmp_path)


def test_dependencies_that_differ_are_told() -> None:
    needed = [
        f"duckdb=={version('duckdb')}",
        "duckdb==0.0.1",
        "no-such-package>=1",
        "numpy>=1",
        "gone; python_version < '3'",
    ]
    assert commit.unmet(needed) == ["duckdb==0.0.1", "no-such-package>=1"]


def test_without_history_it_is_skipped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(commit, "ROOT", tmp_path)
    with pytest.raises(Skipped, match="no git history"):
        commit.unpacked("HEAD", tmp_path)


def test_an_unknown_commit_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["before"])
    assert "name the commit" in capsys.readouterr().err
    if not (ROOT / ".git").exists():
        pytest.skip("before: no git history")
    with pytest.raises(SystemExit, match="before: no commit 'no-such-commit' in "):
        main(["--tiny", "before", "no-such-commit"])


def test_the_scenario_of_the_most_states_is_taken(tmp_path: Path) -> None:
    assert before.densest(tmp_path) is None
    for name, states in {"USA_US101-1_1": 2, "USA_US101-2_1": 3, "USA_US101-3_1": 3, "DEU_A9-1_1": 9}.items():
        (tmp_path / f"{name}_T-1.xml").write_text("<state>" * states, encoding="utf-8")
    assert before.densest(tmp_path) == tmp_path / "USA_US101-2_1_T-1.xml"
