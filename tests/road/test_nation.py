"""Whose law is applied: the nation that the user, the log or its map gives, in this order; the first line names it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from drivelint.audit import AuditRequest, audit
from drivelint.drive.trace import DriveInput
from drivelint.engine.default_rules import selectors_of_run
from drivelint.engine.map_library import MapLibrary
from drivelint.formats import load_map, read_trace
from drivelint.inspect import InspectRequest, inspect
from drivelint.report.law import law_words
from drivelint.report.progress import Silent
from drivelint.road.map_reader import MapSource
from drivelint.run import CheckOptions, check
from drivelint.watch.judge import WindowJudge
from drivelint.watch.options import WatchOptions
from tests.engine.few_states import log_of, states
from tests.formats.commonroad.scenario_text import lanelet, scenario, state
from tests.formats.opendrive.xodr import road, xodr
from tests.formats.osi import osi_log
from tests.report.synthetic import drive, result, rule, verdict
from tests.shared_data import ROOT


def signal(country: str) -> str:
    return (
        f'<signals><signal s="5" t="-2" id="{country}" name="" dynamic="no" orientation="+" zOffset="0" '
        f'country="{country}" type="206" subtype="-1"/></signals>'
    )


OBSTACLE = (
    '<dynamicObstacle id="7"><type>car</type><shape><rectangle><length>4.5</length><width>1.8</width></rectangle></shape>'
    f"{state('initialState', 0, 5.0, 0.0, 0.0)}<trajectory>{state('state', 1, 6.0, 0.0, 0.0)}</trajectory></dynamicObstacle>"
)


def drive_conditions(trace: Any) -> list[tuple[str, str, str]]:
    return [(row["condition"], row["value"], row["source"]) for row in trace.tables["drive_condition"].to_pylist()]


@pytest.mark.parametrize(
    ("benchmark", "env", "expected"),
    [
        ("DEU_T-1_1_T-1", (), [("nation", "de", "trace")]),
        ("ZAM_T-1_1_T-1", (), []),
        ("DEU_T-1_1_T-1", ("nation=gb",), [("nation", "gb", "env")]),
    ],
)
def test_a_scenario_names_its_country_and_the_user_counts_more(
    benchmark: str, env: tuple[str, ...], expected: list[tuple[str, str, str]], tmp_path: Path
) -> None:
    path = tmp_path / "drive.xml"
    path.write_text(scenario(lanelet(1, 0.0), OBSTACLE, benchmark=benchmark))
    assert drive_conditions(read_trace(path, DriveInput(ego="7", env=env).ingest_options())) == expected


@pytest.mark.parametrize(("code", "nation"), [(276, "de"), (826, "gb"), (0, None), (999, None), (None, None)])
def test_the_country_code_of_an_osi_trace(code: int | None, nation: str | None, tmp_path: Path) -> None:
    frames = osi_log.drive(3)
    for frame in frames:
        if code is not None:
            frame.country_code = code
    path = osi_log.write(tmp_path / "drive.mcap", osi_log.truths(frames))
    expected = [] if nation is None else [("nation", nation, "trace")]
    assert drive_conditions(read_trace(path, DriveInput().ingest_options())) == expected


def test_the_map_tells_where_the_log_does_not(tmp_path: Path) -> None:
    road_file = tmp_path / "road.xml"
    road_file.write_text(scenario(lanelet(1, 0.0), benchmark="DEU_T-1"))
    _, log = MapLibrary(DriveInput(map=road_file)).find(log_of(states(5.0)))
    assert drive_conditions(log) == [("nation", "de", "map")]


@pytest.mark.parametrize(
    ("countries", "nation"), [(["DE"], "de"), (["DEU", "OpenDRIVE"], "de"), (["DE", "GB"], None), (["OpenDRIVE"], None)]
)
def test_the_country_of_the_signals_of_an_opendrive_map(countries: list[str], nation: str | None) -> None:
    roads = [road(str(n), more=signal(country)) for n, country in enumerate(countries, 1)]
    assert load_map(MapSource("road.xodr", xodr(*roads).encode())).nation == nation


@pytest.mark.parametrize(
    ("conditions", "words"),
    [
        ([[]], "of gb assumed, as the nation is not known"),
        ([[("us", "trace")]], "of gb not applied: nation us by the log"),
        ([[("gb-wls", "env")]], "of gb applied: nation gb-wls by --env"),
        (
            [[], [("de", "map")]],
            (
                "of gb assumed, as the nation is not known in 1 drive; not applied: nation de by the map in 1 drive; "
                "of de not requested: --rules stvo"
            ),
        ),
    ],
)
def test_the_first_line_names_the_law(conditions: list[list[tuple[str, str]]], words: str) -> None:
    drives = [
        drive(f"d{n}", conditions=[{"condition": "nation", "value": v, "source": s} for v, s in those])
        for n, those in enumerate(conditions)
    ]
    assert law_words(result([verdict("pass")], drives=drives, rules=[rule(law=["gb"])])) == words
    assert not law_words(result([verdict("pass")], drives=drives, rules=[rule()]))


@pytest.mark.parametrize(
    ("benchmark", "env", "rules", "selectors"),
    [
        ("DEU_T-1", (), (), ("ukhc,status:stable", "stvo,status:stable")),
        ("ZAM_T-1", (), (), ()),
        ("ZAM_T-1", ("nation=de",), (), ("ukhc,status:stable", "stvo,status:stable")),
        ("DEU_T-1", ("nation=gb",), (), ()),
        ("DEU_T-1", ("nation=fr",), (), ()),
        ("DEU_T-1", (), ("ukhc.no-collision",), ("ukhc.no-collision",)),
        (None, (), (), ()),
    ],
)
def test_rules_are_by_default_those_of_the_nation(
    benchmark: str | None, env: tuple[str, ...], rules: tuple[str, ...], selectors: tuple[str, ...], tmp_path: Path
) -> None:
    road_file = None
    if benchmark:
        road_file = tmp_path / "road.xml"
        road_file.write_text(scenario(lanelet(1, 0.0), benchmark=benchmark))
    assert selectors_of_run(rules, (), DriveInput(map=road_file, env=env)) == selectors


def test_a_map_that_cannot_be_read_says_no_nation(tmp_path: Path) -> None:
    """The error is that of the drive, which the result has."""
    broken = tmp_path / "road.xodr"
    broken.write_text("no map")
    assert selectors_of_run((), (), DriveInput(map=broken)) == ()


@pytest.mark.ci
@pytest.mark.parametrize(("env", "packs"), [((), {"ukhc"}), (("nation=de",), {"stvo", "ukhc"})])
def test_every_command_judges_by_them(env: tuple[str, ...], packs: set[str], tmp_path: Path) -> None:
    fixture = ROOT / "fixtures" / "overtake"
    log, mapping, map_ = str(fixture / "safe.csv"), str(fixture / "mapping.toml"), fixture / "road.xodr"
    result = check(
        CheckOptions(traces=(log,), map=map_, mapping=mapping, env=env, robustness=False, annotate=False), Silent()
    )
    assert {row["rule_id"].partition(".")[0] for row in result.rules.to_pylist()} == packs
    drive = inspect(InspectRequest(trace=log, map=map_, mapping=mapping, env=env)).drive
    assert drive is not None
    assert set(drive.selection) == packs
    with WindowJudge(WatchOptions(source="-", map=map_, mapping=mapping, env=env)) as judge:
        assert {rule.pack for rule in judge.rules.values()} == packs
    audit(AuditRequest(sources=(log,), out=str(tmp_path / "audit"), map=map_, mapping=mapping, env=env), Silent())
    rules = pq.read_table(tmp_path / "audit" / "rules.parquet").to_pylist()
    assert {row["rule_id"] for row in rules} == {row["rule_id"] for row in result.rules.to_pylist()}
