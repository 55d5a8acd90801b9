"""TOML that a user gives: a key with thousands of parts is refused before tomllib takes memory with the square of their number."""

from __future__ import annotations

import tomllib
import tracemalloc
from typing import TYPE_CHECKING

import pytest

from drivelint.catalogue import read_rule
from drivelint.engine.profiles import load_profiles
from drivelint.errors import DriveLintError
from drivelint.formats.tables.mapping import read_toml
from drivelint.settings import settings_table
from drivelint.toml_text import MAX_KEY_PARTS, parse_toml

if TYPE_CHECKING:
    from pathlib import Path

LONG = ".".join(["a"] * 20_000)


@pytest.mark.parametrize("key", [LONG, LONG.replace(".", " . "), LONG.replace("a", '"a"'), f"[{LONG}]\nb"])
@pytest.mark.parametrize("text", ["{} = 1", "\n\n{} = 1", "x = {{ {} = 1 }}"])
def test_a_key_of_thousands_of_parts(key: str, text: str) -> None:
    tracemalloc.start()
    with pytest.raises(tomllib.TOMLDecodeError, match=r"more than 64 parts \(at line (1|3)\)"):
        parse_toml(text.format(key))
    assert tracemalloc.get_traced_memory()[1] < 5_000_000
    tracemalloc.stop()


def test_others_are_read() -> None:
    long = ".".join(["a"] * MAX_KEY_PARTS)
    assert parse_toml(f"{long} = 1") == tomllib.loads(f"{long} = 1")
    words = "-" * 1_000_000
    assert parse_toml(f"{words} = '{words}'") == {words: words}


def test_every_file_that_a_user_gives(tmp_path: Path) -> None:
    file = tmp_path / "profiles.toml"
    file.write_text(f"{LONG} = 1")
    pack = tmp_path / "mine"
    pack.mkdir()
    (pack / "rule.sql").write_text(f"-- {LONG} = 1\n\n-- @condition\nSELECT 1")
    for read in (
        lambda: read_toml(file),
        lambda: settings_table(file),
        lambda: load_profiles([tmp_path]),
        lambda: read_rule(pack / "rule.sql"),
    ):
        with pytest.raises(DriveLintError, match="more than 64 parts"):
            read()
