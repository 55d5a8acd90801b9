"""`drivelint docs` lists and prints the guides; the guides name what is there."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest

from drivelint import cli, guide
from drivelint.catalogue.header import Conditions, Header
from drivelint.drive.conditions import DRIVE_CONDITION_VALUES, RULE_CONDITION_VALUES
from drivelint.drive.declared_events import ON_OFF_EVENTS
from drivelint.formats.osi.metadata import Event
from drivelint.formats.ros2.messages import MESSAGE_TYPES
from drivelint.guide import dictionary
from drivelint.reasons.signals import REMEDIES, SIGNALS
from drivelint.result.geometry import GEOMETRIES_OF_TABLE
from drivelint.result.names import TABLE_OF_FILE
from drivelint.sql.declarations import column_comments
from drivelint.sql.words import vocabularies
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


def test_docs_prints_the_dictionary(docs: Docs) -> None:
    code, out, err = docs("dictionary")
    assert (code, err) == (0, "")
    blocks = {block.partition("\n")[0]: block for block in out.split("\n\n")}
    for table, columns in column_comments().items():
        rows = [line.split(maxsplit=1) for line in blocks[table].splitlines() if line.startswith("  ")]
        assert [name for name, _ in rows] == list(columns), table
        assert all(said.endswith(columns[name]) for name, said in rows), table
    assert not re.search(r"\\[_*`]|\]\(#", out), "plain text"


def test_docs_prints_one_table(docs: Docs) -> None:
    code, out, err = docs("dictionary", "lead")
    assert (code, err) == (0, "")
    assert out.startswith("lead\nThe nearest vehicle ahead of the ego in the running lane.")
    assert "to know that nobody is within N m, use vehicle_ahead.free_m" in out
    assert "\n\n" not in out.strip()


@pytest.mark.ci
def test_docs_prints_one_vocabulary_and_the_dictionary_all(docs: Docs) -> None:
    code, out, err = docs("dictionary", "lane_type")
    assert (code, err) == (0, "")
    assert out.startswith("[lane_type]\n  driving, entry, exit,")
    assert out in docs("dictionary")[1]
    page = dictionary.page()
    for name, known in vocabularies().items():
        assert f"\n[{name}]\n  {', '.join(known.words)}" in docs("dictionary")[1]
        assert f"\n| `{name}` | {dictionary.escape_markdown(', '.join(known.words))}" in page


def test_an_unknown_table_is_told_with_the_nearest(docs: Docs) -> None:
    for words, said in (
        (("dictionary", "vehicle_ahed"), "did you mean 'vehicle_ahead'?"),
        (("dictionary", "lane_tipe"), "did you mean 'lane_type'?"),
        (("dictionary", "xyz"), "drivelint docs dictionary prints all"),
        (("maps", "lead"), "drivelint docs dictionary lead"),
        (("dictionry",), "did you mean 'dictionary'?"),
    ):
        code, out, err = docs(*words)
        assert (code, out) == (2, "")
        assert said in err
        assert len(err.splitlines()) == 1


def test_docs_prints_the_value_of_a_macro_without_arguments(docs: Docs) -> None:
    code, told, _ = docs("macros")
    assert code == 0
    for signature in ("corridor_ahead_m() = 1000.0", "fork_rad() = radians(10)", "same_level(a_m, b_m)"):
        assert f"| `{signature}` |" in told


def test_docs_prints_the_catalogue(docs: Docs) -> None:
    assert docs("catalogue") == (0, (ROOT / "queries" / "README.md").read_text(encoding="utf-8"), "")


def test_the_guide_of_columns_has_every_column_of_every_file() -> None:
    text = guide.text("columns")
    for stem, table in {**TABLE_OF_FILE, "margins": "margin"}.items():
        section = text.partition(f"### {stem}.parquet\n")[2].partition("\n### ")[0]
        columns = [*column_comments()[table], *GEOMETRIES_OF_TABLE.get(table, ())]
        assert re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE) == columns, stem
        assert f"`{stem}.parquet`" in text.partition("## The columns")[0]


def test_reading_an_unknown_has_every_reason_code() -> None:
    text = guide.text("reading-an-unknown")
    codes = set(re.findall(r"`(\w+)`", "".join(re.findall(r"^\| (`[^|]+)\|", text, re.MULTILINE))))
    required = {f"missing_{signal}" for signal in SIGNALS if signal.removeprefix("mode_") not in ON_OFF_EVENTS}
    assert codes >= REMEDIES.keys() | required | {f"{name}_unknown" for name in (*DRIVE_CONDITION_VALUES, "limit")}


def test_the_guide_of_traces_has_the_keys_of_a_declared_event() -> None:
    section = guide.text("traces").partition("## What the ego declares\n")[2]
    assert tuple(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)) == Event.__struct_fields__
    (message,) = re.findall(r"```text\n(.*?)```", section, re.DOTALL)
    assert msgspec.json.decode(message, type=Event).event == "horn"


def leaves(tree: dict[str, Any], path: str = "") -> set[str]:
    """Return the paths of the fields that are read of a message, joined by dots."""
    return set().union(
        *(leaves(below, f"{path}{name}.") if below else {f"{path}{name}"} for name, below in tree.items())
    )


def test_the_guide_of_traces_has_the_messages_of_ros_that_are_read() -> None:
    """Each field of the table is read, and each that is read is one of the table or below one."""
    table = (
        (guide.FOLDER / "traces.md")
        .read_text(encoding="utf-8")
        .partition("<!-- ros2 messages -->\n")[2]
        .partition("\n\n")[0]
    )
    rows = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in table.splitlines()[2:]]
    assert [name.strip("`| ") for name, *_ in rows] == list(MESSAGE_TYPES)
    for name, topic, role, fields in rows:
        message = MESSAGE_TYPES[name.strip("`| ")]
        assert (topic.strip("`"), role) == (message.topic, message.role), name
        told: set[str] = set()
        for part in fields.strip(" |").split("; "):
            head, _, items = part.partition(": ")
            above = re.findall(r"`([\w.]+)`", head) if items else [""]
            told |= {
                f"{list_}.{field}".strip(".") for list_ in above for field in re.findall(r"`([\w.]+)`", items or part)
            }
        read = leaves(message.fields)
        assert {
            field for field in told if not any(leaf == field or leaf.startswith(f"{field}.") for leaf in read)
        } == set()
        assert {
            leaf for leaf in read if not any(leaf == field or leaf.startswith(f"{field}.") for field in told)
        } == set()


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


def test_the_reference_of_rules_has_every_key_condition_and_signal() -> None:
    text = (guide.FOLDER / "rule-reference.md").read_text(encoding="utf-8")
    sections = {part.partition("\n")[0]: part for part in text.split("\n## ")[1:]}

    def first_cells(heading: str) -> list[str]:
        rows = re.findall(r"^\| (`.*?) \|", sections[heading], re.MULTILINE)
        return [name for cell in rows for name in re.findall(r"`\[?(\w+)[^`]*`", cell)]

    assert first_cells("All keys of the header") == list(Header.__struct_fields__)
    assert first_cells("The conditions under which it applies") == list(Conditions.__struct_fields__)
    assert sorted(first_cells("The signals of requires")) == sorted(SIGNALS)
    for name, words in RULE_CONDITION_VALUES.items():
        row = re.search(rf"^\| `{name}` \| (.*) \|$", sections["The conditions under which it applies"], re.MULTILINE)
        assert row
        named = set(re.findall(r"`([\w-]+)`", row[1]))
        assert named <= set(words), name
        assert named >= {word for word in words if not word.startswith("town") or word == "town"}, name


def test_the_reference_of_rules_names_tables_that_are_there() -> None:
    text = (guide.FOLDER / "rule-reference.md").read_text(encoding="utf-8")
    section = text.partition("\n## Which table is for what\n")[2].partition("\n## ")[0]
    named = {
        name
        for row in re.findall(r"^\| [^|]+ \| (.*) \|$", section, re.MULTILINE)
        for name in re.findall(r"`(\w+)`", row)
    }
    assert named <= column_comments().keys()
    assert {"ego_state", "ego_condition", "lead", "vehicle_ahead", "following", "in_way", "pair"} <= named
    assert "free_m" in column_comments()["vehicle_ahead"]
