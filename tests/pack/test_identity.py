"""`verify` tells of whom and of which day a pack is, and its exit code says so where that is asked."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest
from typer.testing import CliRunner

from drivelint.cli.app import app
from tests.pack.packed import STATEMENT, make_pack

if TYPE_CHECKING:
    from pathlib import Path

    from tests.pack.conftest import Packed

pytestmark = pytest.mark.ci


def exit_code_and_text(*arguments: object) -> tuple[int, str]:
    found = CliRunner().invoke(app, ["verify", *map(str, arguments)])
    return found.exit_code, found.stdout


@pytest.fixture(scope="module")
def dated(packed: Packed, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, Path]:
    """Return packs without their logs: of two days, and of none."""
    home = tmp_path_factory.mktemp("dated")
    older, newer = (make_pack(packed.result, home / day, packed.key, date=day) for day in ("2026-10-31", "2026-11-26"))
    return older, newer, make_pack(packed.result, home / "none", packed.key)


@pytest.mark.slow
def test_without_a_key_nobody_is_identified(dated: tuple[Path, ...], packed: Packed, tmp_path: Path) -> None:
    pack = dated[1]
    code, said = exit_code_and_text(pack)
    assert (code, "consistent" in said, "only --key identifies" in said) == (0, True, True)
    code, said = exit_code_and_text(pack, "--require-signature")
    assert (code, said.startswith("nobody identified: ")) == (1, True)
    assert exit_code_and_text(pack, "--require-signature", "--key", packed.public)[0] == 0
    assert exit_code_and_text(pack, "--require-signature", "--key", packed.other_public)[0] == 1


@pytest.mark.slow
def test_a_pack_that_is_not_signed(packed: Packed, tmp_path: Path) -> None:
    pack = make_pack(packed.result, tmp_path / "pack", None)
    assert not (pack / STATEMENT).exists()
    assert exit_code_and_text(pack)[0] == 0
    for key in ((), ("--key", packed.public)):
        code, said = exit_code_and_text(pack, "--require-signature", *key)
        assert (code, "not signed" in said) == (1, True)


@pytest.mark.slow
def test_an_older_pack_is_told_by_its_date(dated: tuple[Path, ...], packed: Packed, tmp_path: Path) -> None:
    older, newer, without = dated
    swapped = tmp_path / "newest"
    shutil.copytree(older, swapped)
    key = ("--key", packed.public)
    assert ", dated 2026-11-26, " in exit_code_and_text(newer, *key)[1]
    code, said = exit_code_and_text(swapped, *key)
    assert (code, ", dated 2026-10-31, " in said) == (0, True)
    assert ", without a date, " in exit_code_and_text(without, *key)[1]
    assert exit_code_and_text(newer, *key, "--not-before", "2026-11-26")[0] == 0
    for pack in (swapped, without):
        code, said = exit_code_and_text(pack, *key, "--not-before", "2026-11-26")
        assert (code, said.startswith("older pack: ")) == (1, True)
    found = CliRunner().invoke(app, ["verify", str(newer), "--not-before", "yesterday"])
    assert str(found.exception) == "--not-before yesterday is not a valid date: write it as 2026-11-26"
