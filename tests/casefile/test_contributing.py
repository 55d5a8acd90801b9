"""The table of CONTRIBUTING's section *A table* passes its cases and has no mutant that they do not notice, and the dictionary shows it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = re.findall(r"<!-- table: (\S+) -->\n```\w+\n(.*?)```", (ROOT / "CONTRIBUTING.md").read_text("utf-8"), re.DOTALL)


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a checkout with the two files of the guide."""
    folder = tmp_path_factory.mktemp("checkout")
    shutil.copytree(ROOT / "queries", folder / "queries")
    for name in ("src", "schemas"):
        (folder / name).symlink_to(ROOT / name)
    for path, text in FILES:
        assert not (folder / path).exists()
        (folder / path).write_text(text, encoding="utf-8")
    return folder


def output_of(checkout: Path, *args: str) -> str:
    """Return what drivelint prints in this checkout."""
    settings = {**os.environ, "PYTHONPATH": str(checkout / "src"), "DRIVELINT_CACHE_DIR": str(checkout / "cache")}
    command = [sys.executable, "-m", "drivelint", *args]
    return subprocess.run(command, cwd=checkout, env=settings, capture_output=True, text=True, check=True).stdout


@pytest.mark.ci
def test_the_table_of_the_guide_passes(checkout: Path) -> None:
    assert [Path(path).name for path, _ in FILES] == ["standing.sql", "standing.cases.yml"]
    assert output_of(checkout, "rules", "test", "--table", "standing") == "ok   standing: 2 of 2 cases\n"
    assert "ok   standing: 3 of 3 mutants noticed\n" in output_of(
        checkout, "rules", "test", "--table", "standing", "--mutate"
    )
    assert "time since the first step of this stand; NULL: the speed is not known" in output_of(
        checkout, "docs", "dictionary", "standing"
    )


@pytest.mark.ci
@pytest.mark.parametrize("keys", ["BY e.drive_id, e.ego_id ORDER", "BY drive_id, ego_id, seg, run)"])
def test_its_cases_notice_every_lost_key(checkout: Path, keys: str) -> None:
    file = checkout / FILES[0][0]
    text = FILES[0][1]
    assert text.count(keys) == 1
    names = re.findall(r"[\w.]+_id|seg|run", keys)
    assert names
    for name in names:
        fewer = keys.replace(f"{name}, ", "", 1) if f"{name}, " in keys else keys.replace(f", {name}", "", 1)
        file.write_text(text.replace(keys, fewer), encoding="utf-8")
        try:
            with pytest.raises(subprocess.CalledProcessError) as failed:
                output_of(checkout, "rules", "test", "--table", "standing")
        finally:
            file.write_text(text, encoding="utf-8")
        assert failed.value.stdout.startswith("FAIL standing: 1 of 2 cases\n"), name
