"""An option is declared once: the command line, Python, the settings file and the engine agree on it."""

from __future__ import annotations

import dataclasses
import inspect
import sys
from pathlib import Path

import pytest
import typer

import drivelint
from drivelint import cli
from drivelint.api.keywords import replace_options_by_keywords
from drivelint.audit.model import JudgeSettings
from drivelint.drive.trace import DriveInput
from drivelint.engine.judging_options import JudgingOptions
from drivelint.errors import UsageError
from drivelint.options.arguments import CheckArguments, CheckCommandArguments, DriveArguments, RuleArguments
from drivelint.options.declaration import declared_options, engine_values, options_of_engine
from drivelint.options.settings_file import settable_options, settings_of_check


def test_the_engine_has_a_field_for_every_option_about_drives_and_rules() -> None:
    of_drive = {each.field: each.default for each in declared_options(DriveArguments)}
    assert of_drive.keys() == {each.name for each in dataclasses.fields(DriveInput)}
    of_rules = {each.field for each in declared_options(RuleArguments)}
    assert of_rules <= {each.name for each in dataclasses.fields(JudgeSettings)}
    assert of_rules <= {each.name for each in dataclasses.fields(JudgingOptions)}


def test_the_defaults_are_those_of_the_engine() -> None:
    given = options_of_engine(JudgingOptions, engine_values(CheckArguments("x.mcap")))
    assert given == JudgingOptions()
    assert DriveInput(**engine_values(DriveArguments())) == DriveInput()


def test_values_of_python_become_those_of_the_command_line() -> None:
    in_python = DriveArguments(map=Path("a.xodr"), map_offset=(1, 2.5), env={"weather": "wet", "engaged": True}, ego=7)
    on_command_line = DriveArguments(map="a.xodr", map_offset="1,2.5", env=["weather=wet", "engaged=yes"], ego="7")
    assert engine_values(in_python) == engine_values(on_command_line)
    assert engine_values(in_python)["map_offset"] == (1.0, 2.5)
    with pytest.raises(UsageError, match="handedness='left'"):
        engine_values(DriveArguments(handedness="left"))  # type: ignore[arg-type]


def test_the_command_line_has_the_options_in_the_order_of_their_declaration() -> None:
    params = typer.main.get_command(cli.app).commands["check"].params  # type: ignore[attr-defined]
    declared = declared_options(CheckCommandArguments)
    assert [param.name for param in params] == [each.field for each in declared]
    assert [param.help for param in params if param.param_type_name == "option"] == [
        each.option.help for each in declared if not each.is_positional
    ]
    names = [each.name for each in declared]
    assert names.index("format_") == names.index("min_judged") + 1, "an option may be placed after another"


def test_python_has_the_keywords_in_the_order_of_their_declaration() -> None:
    names = [each.name for each in declared_options(CheckArguments)]
    assert [*inspect.signature(drivelint.check).parameters] == [*names, "progress"]
    assert str(inspect.signature(drivelint.check)).startswith("(traces: 'Paths', *, map: 'AnyPath | None' = None, ")


def test_a_settings_file_knows_the_options_but_not_the_day(tmp_path: Path) -> None:
    keys = settable_options().keys()
    assert {"map-dir", "fail-on", "no-cache"} & keys == {"map-dir", "fail-on"}
    assert "today" not in keys
    file = tmp_path / "drivelint.toml"
    file.write_text('rules-dir = ["mine"]\nsensor-range = 80\nmapping = "esmini"\n', encoding="utf-8")
    assert settings_of_check(file) == {
        "rules_dirs": [str(tmp_path / "mine")],
        "sensor_range_m": "80",
        "mapping": "esmini",
    }


def test_inspect_reads_rules_of_the_settings_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "drivelint.toml").write_text('rules-dir = ["no-such-folder"]\n', encoding="utf-8")
    (tmp_path / "x.csv").write_text("t,x\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["drivelint", "inspect", "x.csv"])
    with pytest.raises(SystemExit):
        cli.main()
    assert "no-such-folder" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("--map-dir DIR: no such folder", "map_dir=DIR: no such folder"),
        ("--keep-db writes a file", "keep_db=True writes a file"),
        ("that --no-robustness leaves out", "that robustness=False leaves out"),
        ("--today 'x': write a day", "today='x': write a day"),
        ("the folder that check --out wrote", "the folder that check --out wrote"),
        ("rosbags-convert --src a --dst b", "rosbags-convert --src a --dst b"),
        ("convert LOG --to parquet", "convert LOG --to parquet"),
    ],
)
def test_a_message_names_keywords_of_python(text: str, expected: str) -> None:
    assert replace_options_by_keywords(text) == expected
