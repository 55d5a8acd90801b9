"""A contact is told by when it began; how deep it was later stands beside that."""

from __future__ import annotations

import io
import json
import re
from typing import Any

import pytest
from lxml import etree
from rich.console import Console

from drivelint.api.notebook import summary_html
from drivelint.report import junit, markdown, sarif, terminal, xqar
from drivelint.result.model import Result
from tests.report.pages import page
from tests.report.synthetic import SECOND, drive, finding, result, rule, verdict

TIME_TEXT = "11.80 s (deepest at 12.20 s)"


def contact(**over: Any) -> Result:
    """Return a contact from 11.8 s to 15 s of a drive, deepest at 12.2 s; its clock tells UTC."""
    times = {"t_start_ns": 111_800_000_000, "t_worst_ns": 112_200_000_000, "t_end_ns": 115 * SECOND}
    row = {"rule_id": "ukhc.no-collision", "profile": None, "observed": -0.3, "required": 0.0, "margin": -0.3}
    row |= times | {"closing_mps": 10.44} | over
    rules = [rule("ukhc.no-collision", tags=["contact"], title="No collision", sense=">=")]
    said = verdict("fail", **{key: value for key, value in row.items() if key != "closing_mps"})
    return result([said], [finding(**row)], drives=[drive()], rules=rules)


def screen(of: Result, *, verbose: bool = False) -> str:
    console = Console(file=io.StringIO(), width=140, force_terminal=False)
    console.print(terminal.render(of, "out", 140, verbose=verbose))
    return console.file.getvalue()  # type: ignore[attr-defined, no-any-return]


def plain(html: str) -> str:
    return " ".join(re.sub(r"<[^>]+>", "", html).replace("\u00a0", " ").split())


def test_the_page_says_when_it_began() -> None:
    text = page(contact())
    body = plain(text)
    assert f"The worst moment {TIME_TEXT}" in body
    assert "ego 1 and object 3 at 11.80 s, closing at 10.44 m/s, 0.30 m deep at 12.20 s." in body
    (cell,) = re.findall(r'data-label="when">(.*?)</td>', text)
    assert plain(cell) == TIME_TEXT
    assert "first contact at 11.80 s" in body, "where the picture of the deepest step is"


@pytest.mark.parametrize(
    "text",
    [
        lambda of: etree.fromstring(junit.render(of)).xpath("string(//failure)"),
        lambda of: markdown.render(of).decode().replace("\\", ""),
        lambda of: json.loads(sarif.render(of))["runs"][0]["results"][0]["message"]["text"],
        lambda of: etree.fromstring(xqar.render(of)).xpath("string(//Issue/@description)"),
        summary_html,
    ],
    ids=["junit", "markdown", "sarif", "xqar", "notebook"],
)
def test_every_report_says_both_times(text: Any) -> None:
    assert TIME_TEXT in text(contact())


def test_the_terminal_says_both_times() -> None:
    assert re.search(r"11\.80 s CONTACT object 3; closing at 10\.44 m/s; deepest at 12\.20 s", screen(contact()))
    assert re.search(r"11\.80 s +ukhc.no-collision", screen(contact(), verbose=True))


def test_sarif_has_each_time_by_itself() -> None:
    told = json.loads(sarif.render(contact()))["runs"][0]["results"][0]["properties"]
    assert (told["start_s"], told["worst_s"], told["end_s"]) == pytest.approx((11.8, 12.2, 15.0))


def test_one_time_is_said_once() -> None:
    for of in (contact(t_worst_ns=111_800_000_000), contact(rule_id="ukhc.no-collision", t_start_ns=112_200_000_000)):
        assert "deepest at" not in screen(of)
        assert "first contact" not in page(of)


def test_what_is_no_contact_is_told_by_its_worst_step() -> None:
    of = contact()
    rules = of.rules.to_pylist()
    rules[0]["tags"] = []
    other = result(of.verdicts.to_pylist(), of.findings.to_pylist(), drives=[drive()], rules=rules)
    assert " 12.20 s -0.30 m" in screen(other)
    assert "11.80 s (" not in page(other)
