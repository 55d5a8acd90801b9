"""`drivelint.toml` stands in for options, and refuses what it does not understand."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from drivelint import cli
from drivelint.errors import UsageError
from drivelint.settings import read_settings
from tests.shared_data import ROOT

OPTIONS = {
    "map": ("map_", False),
    "strict": ("strict", False),
    "sensor-range": ("sensor_range", False),
    "rules": ("rules", True),
    "env": ("env", True),
}
OVERTAKE = ROOT / "fixtures" / "overtake"


def written(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "drivelint.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_no_file_says_nothing(tmp_path: Path) -> None:
    assert read_settings(OPTIONS, tmp_path / "drivelint.toml") == {}


def test_values_are_those_of_the_options(tmp_path: Path) -> None:
    file = written(tmp_path, 'map = "road.xodr"\nstrict = true\nsensor-range = 80\nrules = ["ukhc", "rss"]\n')
    assert read_settings(OPTIONS, file) == {
        "map_": "road.xodr",
        "strict": True,
        "sensor_range": "80",
        "rules": ["ukhc", "rss"],
    }


def test_conditions_are_a_table_of_their_own(tmp_path: Path) -> None:
    file = written(tmp_path, '[env]\nnation = "gb"\nengaged = true\n')
    assert read_settings(OPTIONS, file) == {"env": ["nation=gb", "engaged=yes"]}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("map = ", "not TOML"),
        ('mpa = "x"', r"unknown setting 'mpa'; did you mean 'map'"),
        ("zzz = 1", "known are env, map, rules, sensor-range, strict"),
        ('rules = "ukhc"', "rules.*must be a list"),
        ("rules = [1]", "rules.*must be a list"),
        ('map = ["x"]', "map.*must be one value"),
        ("[map]\nx = 1", "map.*must be one value"),
        ("[env]\nweather = 1", r"\[env\] weather = 1: must be a text"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(UsageError, match=rf"drivelint\.toml: .*{says}"):
        read_settings(OPTIONS, written(tmp_path, text))


def run(monkeypatch: pytest.MonkeyPatch, *args: str) -> object:
    monkeypatch.setattr(sys, "argv", ["drivelint", *args])
    with pytest.raises(SystemExit) as left:
        cli.main()
    return left.value.code


@pytest.mark.slow
def test_the_file_sets_options_and_the_command_line_overrides_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    lines = [
        f'map = "{OVERTAKE / "road.xodr"}"',
        f'mapping = "{OVERTAKE / "mapping.toml"}"',
        'rules = ["ukhc.r162.safe-distance-ahead"]',
        'fail-on = "never"',
        "quiet = true",
    ]
    written(tmp_path, "\n".join(lines))
    monkeypatch.chdir(tmp_path)
    collision = str(OVERTAKE / "collision.csv")
    assert run(monkeypatch, "check", collision) == 0
    assert run(monkeypatch, "check", collision, "--fail-on", "critical") == 1
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("text", ['fail-onn = "never"', 'fail-on = "nevre"'])
def test_a_mistake_in_it_names_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], text: str
) -> None:
    written(tmp_path, text)
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "check", "x.csv") == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert "drivelint.toml" in err
    assert len(err.splitlines()) == 1
