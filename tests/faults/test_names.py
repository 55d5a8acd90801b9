"""Names of files, topics and road users are data: exactly that file is read, and words of a log are text wherever they are shown."""

from __future__ import annotations

import json
import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Final

import pytest
from lxml import etree

import drivelint
from drivelint import cli
from tests.faults import drives
from tests.formats.foxglove import foxglove_log as fox

if TYPE_CHECKING:
    from pathlib import Path

RULES = "ukhc.no-collision"
NAMES: Final = ("d[1]", "d*", "d?", "x=9", "new\nline", "..d", "$(x) `y`; z")
HOSTILE = ["ego'; DROP TABLE verdict; --", '"><script>alert(1)</script>', "]]>&amp;{{7*7}}\u202e`| x |"]
FORMATS: Final = ("html", "junit", "sarif", "xqar", "markdown")
TOPIC = "/<b>'; DROP TABLE actor; --"


@pytest.mark.ci
@pytest.mark.skipif(os.name != "posix", reason="files cannot have such names")
def test_exactly_that_file(tmp_path: Path) -> None:
    """Beside them lies a file that globs of their names would find, without anybody in it but the ego."""
    drives.parquet(tmp_path / "d1", drives.drive(cars=1))
    logs = [drives.parquet(tmp_path / f"{name}.parquet", drives.drive(drives.N + k)) for k, name in enumerate(NAMES)]
    result = drivelint.check(logs, rules=RULES, ego="0", annotate=False, robustness=False)
    assert {row["file_name"] for row in result.drives.arrow().to_pylist()} == {log.name for log in logs}
    assert result.verdicts.arrow()["object_id"].to_pylist() == ["1", "2"] * len(NAMES)


@pytest.mark.ci
def test_words_of_a_log_are_text_everywhere(tmp_path: Path) -> None:
    """Two of its cars drive into each other, so that every report has something to say of them."""
    messages = [
        fox.scene(
            t_s,
            *(fox.entity(HOSTILE[int(car.name)], t_s, car.x, 0.3 * car.y) for car in cars),
            topic=TOPIC,
        )
        for t_s, cars in drives.drive()
    ]
    log = fox.write(tmp_path / "log.mcap", messages)
    result = drivelint.check([log], rules=RULES, ego=HOSTILE[0], robustness=False, out=tmp_path / "out")
    assert result.exit_code == 1
    rows = result.verdicts.arrow().to_pylist()
    assert {(row["ego_id"], row["object_id"]) for row in rows} == {(HOSTILE[0], name) for name in HOSTILE[1:]}
    for format_ in FORMATS:
        text = result.report(to=format_)
        if format_ != "sarif":  # JSON has no markup
            assert "<script>alert(1)" not in text
        if format_ in {"junit", "xqar"}:
            etree.fromstring(text.encode("utf-8"))
        if format_ == "sarif":
            json.loads(text)
    (annotated,) = (tmp_path / "out" / "annotated").glob("*.mcap")
    assert drivelint.read_trace(annotated, ego=HOSTILE[0], topic=TOPIC).drive_id


def test_a_name_as_long_as_names_can_be_stops_nobody(tmp_path: Path) -> None:
    """Its annotated log would have a longer one."""
    logs = [
        drives.osi_mcap(tmp_path / (letter * n), drives.drive()) for letter, n in (("a", 5), ("n", 241), ("m", 250))
    ]
    result = drivelint.check(logs, rules=RULES, ego="0", robustness=False, out=tmp_path / "out")
    assert result.exit_code == 0
    assert len(result.verdicts.arrow()) == 6
    assert {path.name[0] for path in (tmp_path / "out" / "annotated").glob("*.mcap")} == {"a", "n"}
    assert [note for note in result.notes if "the name is too long for a file" in note]


def test_a_fault_of_drivelint_is_no_broken_rule(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> None:
        raise OSError("a fault")

    monkeypatch.setattr(sys, "argv", ["drivelint", "--version"])
    monkeypatch.setattr(import_module("drivelint.cli.app"), "_default_options_of_settings_file", fail)
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == 4
    assert capsys.readouterr().err.endswith("drivelint: error: internal error: OSError: a fault: please report it\n")
