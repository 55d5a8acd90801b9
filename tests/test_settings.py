"""`drivelint.toml` stands in for options, and refuses what it does not understand."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from drivelint import cli
from drivelint.errors import UsageError
from drivelint.gate import waivers
from drivelint.settings import find_settings, read_settings
from tests.shared_data import ROOT

OPTIONS = {
    "map": ("map_", False),
    "strict": ("strict", False),
    "sensor-range": ("sensor_range", False),
    "rules": ("rules", True),
    "env": ("env", True),
}
OVERTAKE = ROOT / "fixtures" / "overtake"


def settings_file(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "drivelint.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_no_file_says_nothing(tmp_path: Path) -> None:
    assert read_settings(OPTIONS, tmp_path / "drivelint.toml") == {}


def test_values_are_those_of_the_options(tmp_path: Path) -> None:
    file = settings_file(tmp_path, 'map = "road.xodr"\nstrict = true\nsensor-range = 80\nrules = ["ukhc", "rss"]\n')
    assert read_settings(OPTIONS, file) == {
        "map_": "road.xodr",
        "strict": True,
        "sensor_range": "80",
        "rules": ["ukhc", "rss"],
    }


def test_conditions_are_a_table_of_their_own(tmp_path: Path) -> None:
    file = settings_file(tmp_path, '[env]\nnation = "gb"\nengaged = true\n')
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
        read_settings(OPTIONS, settings_file(tmp_path, text))


def test_the_nearest_file_upwards_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    below = tmp_path / "a" / "b"
    below.mkdir(parents=True)
    monkeypatch.chdir(below)
    assert find_settings() is None
    settings_file(tmp_path, 'map = "far.xodr"')
    assert find_settings() == tmp_path / "drivelint.toml"
    (tmp_path / "a" / "pyproject.toml").write_text('[tool.drivelint]\nmap = "near.xodr"\n', encoding="utf-8")
    assert find_settings() == tmp_path / "a" / "pyproject.toml"
    (below / "pyproject.toml").write_text('[project]\ndependencies = ["drivelint"]\n', encoding="utf-8")
    assert find_settings() == tmp_path / "a" / "pyproject.toml", "one without our table is of other tools"
    (below / "drivelint.toml").write_text("", encoding="utf-8")
    assert find_settings() == Path("drivelint.toml")


def test_paths_start_in_the_folder_of_the_file(tmp_path: Path) -> None:
    file = tmp_path / "pyproject.toml"
    (tmp_path / "mine.toml").touch()
    text = '[tool.drivelint]\nmap = "road.xodr"\nmapping = "{}"\nrules-dir = ["mine", "/abs"]\n'
    options = {"map": ("map", False), "mapping": ("mapping", False), "rules-dir": ("rules_dir", True)}
    for mapping, expected in (("mine.toml", str(tmp_path / "mine.toml")), ("esmini", "esmini")):
        file.write_text(text.format(mapping), encoding="utf-8")
        said = read_settings(options, file, options.keys())
        assert said == {
            "map": str(tmp_path / "road.xodr"),
            "mapping": expected,
            "rules_dir": [str(tmp_path / "mine"), "/abs"],
        }


def test_waivers_of_a_project(tmp_path: Path) -> None:
    file = tmp_path / "pyproject.toml"
    head = '[project]\nname = "x"\n\n[tool.drivelint]\nstrict = true\n\n'
    waiver = '[[tool.drivelint.waiver]]\nrule = "ukhc.*"\nreason = "a prop"\nowner = "jo"\nexpires = 2099-12-31\n'
    file.write_text(head + waiver, encoding="utf-8")
    (found,) = waivers.read(file, only_waivers=False)
    assert (found.rule, found.where) == ("ukhc.*", f"{file}:7")


def test_the_schema_of_a_rules_header_is_printed(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    assert run(monkeypatch, "docs", "header-schema") == 0
    kept = json.loads((ROOT / "schemas" / "assertion-header.schema.json").read_text(encoding="utf-8"))
    assert json.loads(capfd.readouterr().out) == kept


def test_the_schema_for_editors_is_that_of_the_options(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """drivelint docs settings-schema > schemas/settings.schema.json"""
    import jsonschema

    assert run(monkeypatch, "docs", "settings-schema") == 0
    printed = capfd.readouterr().out
    assert (ROOT / "schemas" / "settings.schema.json").read_text(encoding="utf-8") == printed
    schema = json.loads(printed)
    jsonschema.Draft202012Validator.check_schema(schema)
    told = {
        "map": "x.xodr",
        "profile": ["nominal"],
        "fail-on": "major",
        "env": {"nation": "gb", "engaged": True},
        "min-judged": 0.5,
    }
    jsonschema.validate(told, schema)
    for wrong in ({"fail-on": "nevre"}, {"mpa": "x"}, {"profile": "nominal"}, {"waiver": [{"rule": "x"}]}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(told | wrong, schema)


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
    settings_file(tmp_path, "\n".join(lines))
    monkeypatch.chdir(tmp_path)
    collision = str(OVERTAKE / "collision.csv")
    assert run(monkeypatch, "check", collision) == 0
    assert run(monkeypatch, "check", collision, "--fail-on", "critical") == 1
    assert capfd.readouterr().err == ""


def test_a_map_that_does_not_exist_names_the_file_unless_the_command_line_has_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    settings_file(tmp_path, 'map = "roda.xodr"\nquiet = true')
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "inspect", "x.csv") == 2
    assert "drivelint.toml: map = 'roda.xodr': does not exist: correct it, or give --map" in capfd.readouterr().err
    run(monkeypatch, "inspect", "x.csv", "--map", "other.xodr")
    assert "drivelint.toml" not in capfd.readouterr().err


@pytest.mark.parametrize("text", ['fail-onn = "never"', 'fail-on = "nevre"'])
def test_a_mistake_in_it_names_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], text: str
) -> None:
    settings_file(tmp_path, text)
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "check", "x.csv") == 2
    out, err = capfd.readouterr()
    assert out == ""
    assert "drivelint.toml" in err
    assert len(err.splitlines()) == 1


def test_a_wrong_parameter_names_the_file_only_if_it_stands_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    wrong = "ukhc.overtake-zone.margn_s=0.9"
    settings_file(tmp_path, f'param = ["{wrong}"]\nquiet = true')
    monkeypatch.chdir(tmp_path)
    assert run(monkeypatch, "check", str(OVERTAKE / "safe.csv")) == 2
    assert capfd.readouterr().err.endswith("it has: margin_s (see drivelint.toml)\n")
    assert run(monkeypatch, "check", str(OVERTAKE / "safe.csv"), "--param", wrong) == 2
    assert "drivelint.toml" not in capfd.readouterr().err
