"""What `--env` takes, and how a drive is judged by it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from drivelint.drive import conditions
from drivelint.errors import UsageError
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check
from tests.evaluate.packs import INVARIANT, MEASURE, write
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.result.model import Result

OVERTAKE = ROOT / "fixtures" / "overtake"


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        (["weather"], "write KEY=VALUE, such as weather=wet"),
        (["wether=wet"], "'wether' is no condition of a drive; did you mean 'weather'"),
        (["zzz=1"], "known are road_type, carriageway, area, nation, weather, light, vehicle_class, engaged"),
        (["weather=wett"], "'wett' is no weather; did you mean 'wet'"),
        (["weather="], "'' is no weather; known are dry, wet, ice"),
        (["light=dusk"], "known are day, night"),
        (["nation=uk"], "use 'gb'"),
        (["nation=GBR"], "did you mean 'gb'"),
        (["nation=UK"], "use 'gb'"),
        (["nation=GB", "nation=DE"], "nation is 'gb' already"),
        (["engaged=true"], "known are yes, no"),
        (["weather=wet", "weather=dry"], "weather is 'wet' already: a drive has one weather"),
    ],
)
def test_what_is_not_understood_is_refused_with_the_nearest(settings: list[str], says: str) -> None:
    with pytest.raises(UsageError, match=f"--env .*{says}"):
        conditions.parse_env_settings(settings)


def test_conditions_come_in_one_order_and_once() -> None:
    given = ["weather=wet", " nation = gb-sct ", "weather=wet", "engaged=no"]
    assert conditions.parse_env_settings(given) == (("engaged", "no"), ("nation", "gb-sct"), ("weather", "wet"))


def test_words_are_taken_in_any_case() -> None:
    given = ["Nation=GB", "WEATHER=Wet", "road_type=TOWNLOCAL", "vehicle_class=Goods_7t5", "engaged=Yes"]
    assert conditions.parse_env_settings(given) == (
        ("engaged", "yes"), ("nation", "gb"), ("road_type", "townLocal"), ("vehicle_class", "goods_7t5"), ("weather", "wet"),
    )  # fmt: skip
    assert conditions.parse_env_settings(["nation=FR"]) == (("nation", "fr"),)


def check_result(tmp_path: Path, *env: str) -> Result:
    """Judge a drive by one rule, for wet roads in Great Britain."""
    sql = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, -1 AS required FROM ego_state"
    tables = '[applies]\nweather = ["wet"]\nnation = ["gb"]'
    if not (tmp_path / "pack").exists():
        write(tmp_path, INVARIANT | MEASURE | {"reads": '["ego_state"]'}, {"condition": sql}, tables=tables)
    settings = CheckOptions(
        (str(OVERTAKE / "safe.csv"),), map=OVERTAKE / "road.xodr", mapping=str(OVERTAKE / "mapping.toml"),
        rules=("pack",), rules_dirs=(tmp_path,), env=env, robustness=False,
    )  # fmt: skip
    return check(settings, Silent())


@pytest.mark.slow
def test_a_drive_is_judged_in_the_conditions_given(tmp_path: Path) -> None:
    def verdict(*env: str) -> tuple[str, str]:
        (row,) = check_result(tmp_path, *env).verdicts.to_pylist()
        return row["verdict"], row["reason_code"]

    assert verdict() == ("unknown", "nation_unknown")
    assert verdict("nation=gb-eng") == ("unknown", "weather_unknown")
    assert verdict("nation=gb-eng", "weather=dry") == ("not_applicable", "not_triggered")
    assert verdict("nation=gb-eng", "weather=wet") == ("pass", "kept")
    assert verdict("nation=gb-eng", "weather=wet", "engaged=no") == ("not_applicable", "not_engaged")


@pytest.mark.ci
def test_the_result_says_in_which_conditions(tmp_path: Path) -> None:
    from drivelint.report import summary

    bare, given = check_result(tmp_path), check_result(tmp_path, "weather=wet", "light=day")
    said = [
        {"condition": "light", "value": "day", "source": "env"},
        {"condition": "weather", "value": "wet", "source": "env"},
    ]
    assert [drive["conditions"] for drive in given.drives.to_pylist()] == [said]
    assert [drive["conditions"] for drive in bare.drives.to_pylist()] == [[]]
    assert [drive["conditions"] for drive in json.loads(summary.render(given))["drives"]] == [said]
    # the drive and its map are what they were
    for name in ("drive_id", "sha256", "environment_id"):
        assert given.drives[name] == bare.drives[name]
