"""`drivelint docs` lists and prints the guides; the guides name what is there."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from drivelint import cli, guide
from drivelint.drive.conditions import GIVEN
from drivelint.drive.declared import MODES
from drivelint.formats.osi.extras import Event
from drivelint.reasons.remedies import REMEDIES
from drivelint.reasons.signals import SIGNALS
from drivelint.result.contract import FILES
from drivelint.sql.store import schema
from tests.guide.blocks import PAGES
from tests.shared_data import ROOT

GUIDES = PAGES[1:]
Docs = Callable[..., tuple[int, str, str]]


@pytest.fixture
def docs(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Docs:
    def run(*args: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["drivelint", "docs", *args])
        with pytest.raises(SystemExit) as left:
            cli.main()
        assert isinstance(left.value.code, int)
        return left.value.code, *capsys.readouterr()

    return run


def test_every_guide_is_a_topic() -> None:
    assert sorted(guide.TOPICS) == [page.stem for page in GUIDES]


@pytest.mark.parametrize("page", GUIDES, ids=lambda page: page.stem)
def test_a_guide_begins_with_its_title_and_one_sentence(page: Path) -> None:
    title, blank, sentence, end, *_ = page.read_text(encoding="utf-8").splitlines()
    assert re.fullmatch(r"# \S.*", title)
    assert (blank, end) == ("", "")
    assert re.fullmatch(r"[^.]+(?:\.\w[^.]*)*\.", sentence), "one sentence on a line of its own"
    assert len(page.read_text(encoding="utf-8").splitlines()) < 250


def test_docs_lists_the_topics_with_their_sentence(docs: Docs) -> None:
    code, out, err = docs()
    assert code == 0
    assert [line.split()[0] for line in out.splitlines()] == list(guide.TOPICS)
    assert "drivelint docs TOPIC" in err


def test_docs_prints_a_guide(docs: Docs) -> None:
    code, out, err = docs("maps")
    assert (code, err) == (0, "")
    assert out.startswith("# Maps\n")
    assert "<!--" not in out


def test_an_unknown_topic_is_told_with_the_nearest(docs: Docs) -> None:
    code, out, err = docs("mappings")
    assert (code, out) == (2, "")
    assert "did you mean 'mapping'?" in err
    assert len(err.splitlines()) == 1
    assert docs("maps", "--html", "x")[0] == 2


def test_the_guide_of_columns_has_every_column_of_every_file() -> None:
    text = guide.text("columns")
    for stem, table in {**FILES, "margins": "margin"}.items():
        section = text.partition(f"### {stem}.parquet\n")[2].partition("\n### ")[0]
        assert re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE) == list(schema()[table]), stem
        assert f"`{stem}.parquet`" in text.partition("## The columns")[0]


def test_reading_an_unknown_has_every_reason_code() -> None:
    text = guide.text("reading-an-unknown")
    codes = set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`[^|]+)\|", text, re.MULTILINE))))
    required = {f"missing_{signal}" for signal in SIGNALS if signal.removeprefix("mode_") not in MODES}
    assert codes >= REMEDIES.keys() | required | {f"{name}_unknown" for name in (*GIVEN, "limit")}


def test_the_guide_of_traces_has_the_keys_of_a_declared_event() -> None:
    section = guide.text("traces").partition("## What the ego declares\n")[2]
    assert tuple(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)) == Event.__struct_fields__
    (message,) = re.findall(r"```text\n(.*?)```", section, re.DOTALL)
    assert msgspec.json.decode(message, type=Event).event == "horn"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_paths_lead_to_something(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    targets = [t.partition("#")[0] for t in re.findall(r"\]\((?!https?:)([^)]+)\)", text)]
    assert [target for target in targets if not (page.parent / target).exists()] == []
    paths = re.findall(r"`((?:fixtures|schemas|queries|tests|src|\.ci)/[^`<>*]*)`", text)
    assert [path for path in paths if not (ROOT / path).exists()] == []


def test_the_architecture_names_the_layers_of_the_linter() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contract = project["tool"]["importlinter"]["contracts"][0]
    layers = [{name.strip().removeprefix("drivelint.") for name in line.split("|")} for line in contract["layers"]]
    table = (guide.FOLDER / "architecture.md").read_text(encoding="utf-8").partition("<!-- layers -->")[2]
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|", table.partition("\n## ")[0], re.MULTILINE)
    assert [set(re.findall(r"\w+", row)) for row in rows] == layers
