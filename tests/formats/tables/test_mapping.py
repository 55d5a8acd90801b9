"""Mapping files: found by name or path, refused with one clear line."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.errors import UsageError
from drivelint.formats.tables.mapping import load, needed_columns, shipped_mappings
from tests.formats.logs import LONG, mapping

if TYPE_CHECKING:
    from pathlib import Path


def test_every_shipped_mapping_loads() -> None:
    assert {"carla-testbench", "esmini", "omega-prime"} <= set(shipped_mappings())
    for name in shipped_mappings():
        loaded, spec = load(name)
        assert loaded == name
        assert spec.description
        assert needed_columns(spec)


def test_the_registration_of_the_case_study_lives_in_its_mapping() -> None:
    assert load("carla-testbench")[1].frame.map_offset_m == (2.618, 3.113)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (LONG.replace("yaw =", "yav ="), r"unknown key 'columns\.yav': did you mean 'yaw'\?"),
        (LONG.replace("[ego]", "[ega]"), r"unknown key 'ega': did you mean 'ego'\?"),
        (LONG + "[frame]\nzzz = 1\n", r"unknown key 'frame\.zzz': known are flip_y"),
        (LONG.replace('"vx"', '{ colum = "vx" }'), r"unknown key 'columns\.vx\.colum': did you mean 'column'\?"),
        (LONG + '[class]\ncolumn = "x"\npatterns = [{ math = "a", is = "car" }]\n', r"did you mean 'match'\?"),
        (LONG.replace('x = "x"\n', ""), r"missing required field `x`"),
        (
            LONG.replace('yaw = "yaw"', 'yaw = { column = "yaw", unit = "degree" }'),
            r"yaw: unknown unit 'degree': use rad, deg",
        ),
        (LONG.replace('vy = "vy"\n', ""), r"vx and vy need each other, and so do ax and ay"),
        (LONG.replace('vx = "vx"', 'speed = "v"\nvx = "vx"'), r"vx and vy or speed, not both"),
        (LONG.replace('yaw = "yaw"\n', "") + '[reference]\npoint = "front_bumper"\n', r"need columns\.yaw"),
        (LONG + '[reference]\npoint = "rear_axle"\n', r"'rear_axle' needs reference\.forward"),
        (LONG.replace("length = 4.5\n", "") + '[reference]\npoint = "front_bumper"\n', r"needs columns\.length"),
        (LONG + "[reference]\nforward = 1.0\n", r"need reference\.point = 'rear_axle'"),
        (LONG + '[reference]\npoint = "axle"\n', r"Invalid enum value 'axle'"),
        (
            LONG + '[class]\ncolumn = "x"\npatterns = [{ match = "a", is = "cyclist" }]\n',
            r"'cyclist' .*did you mean 'bicycle'\?",
        ),
        (LONG + '[brake_light]\ncolumn = "x"\nvalues = { b = "onn" }\n', r"brake_light: 'onn' .*did you mean 'on'\?"),
        (LONG + '[class]\ncolumn = "x"\ndefault = "lorry"\n', r"class: 'lorry' is not one of its words: known are car"),
        (LONG + '[indicator]\ncolumn = "x"\nvalues = { l = "lefft" }\n', r"indicator: 'lefft' .*did you mean 'left'\?"),
        (LONG + '[class]\ncolumn = "x"\npatterns = [{ match = "(", is = "car" }]\n', r"not a regular expression"),
        (LONG.replace('ids = ["a"]', 'ids = ["a"]\notherwise = "first"'), r"needs column groups"),
        (LONG.replace('x = "x"', 'x = { column = "x", value = 1.0 }'), r"x: give either a column or a value"),
        (LONG.replace('x = "x"', 'x = { value = "1" }'), r"x: the value '1' is not a number"),
        (LONG + '[table]\nseparator = ", "\n', r"table\.separator must be one character"),
        (LONG + "[frame\n", r"not valid TOML"),
    ],
)
def test_wrong_mappings(tmp_path: Path, text: str, message: str) -> None:
    name = mapping(tmp_path, text)
    with pytest.raises(UsageError, match=message) as error:
        load(name)
    assert str(error.value).startswith(f"mapping {name}: ")
    assert "\n" not in str(error.value)


def test_names_that_are_no_mapping(tmp_path: Path) -> None:
    with pytest.raises(
        UsageError, match=r"'carla-testbensh': neither a file nor a shipped mapping: did you mean 'carla-testbench'"
    ):
        load("carla-testbensh")
    with pytest.raises(UsageError, match=r"shipped mapping: known are carla-testbench, esmini"):
        load("qqqq")
    with pytest.raises(UsageError, match="neither a file"):
        load(str(tmp_path))
