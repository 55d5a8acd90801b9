"""The page: what it says, that it is escaped, closed to the outside, and the same bytes for the same result."""

from __future__ import annotations

import base64
import hashlib
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from drivelint.errors import UsageError
from drivelint.report.contract import FILES
from drivelint.report.load import load
from drivelint.report.outputs import write
from drivelint.report.result import Result
from tests.report import test_evidence
from tests.report.synthetic import SECOND, drive, finding, result, rule, table, verdict

NASTY = "<script>alert(1)</script>\"'&</style></svg><img src=x onerror=alert(2)>"


def page(run: Result) -> str:
    from drivelint.report.html import render

    return render(run).decode()


class Parsed(HTMLParser):
    """Tags, ids and links of a page, and where tags do not match."""

    VOID = frozenset({"meta", "link", "br", "img", "input", "hr"})
    SVG_LEAVES = frozenset({"path", "rect", "circle", "use"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] not in {"script", "style"}:
            self.text += data

    def all(self, attribute: str) -> list[str]:
        return [value for _, attrs in self.tags if (value := attrs.get(attribute)) is not None]


@pytest.fixture(scope="module")
def overtakes(tmp_path_factory: pytest.TempPathFactory) -> Result:
    return test_evidence.run(tmp_path_factory.mktemp("overtakes"))


@pytest.fixture(scope="module")
def text(overtakes: Result) -> str:
    return page(overtakes)


def nasty() -> Result:
    """Return a result in which everything that a log, a map or a rule names is markup."""
    names = {"drive_id": NASTY, "ego_id": NASTY, "object_id": NASTY, "reason": NASTY, "unit": NASTY, "profile": NASTY}
    check = {"check_id": NASTY, "severity": "warning", "actor_id": NASTY, "n": 1, "t_first_ns": 0, "message": NASTY}
    shape = {"left_x_m": [-50.0, 50.0], "left_y_m": [2.0, 2.0], "right_x_m": [-50.0, 50.0], "right_y_m": [-2.0, -2.0]}
    actor = {
        "actor_id": NASTY, "actor_class": NASTY, "length_m": 4.0, "width_m": 2.0, "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0,
        "speed_mps": 1.0, "path": [],
    }  # fmt: skip
    return Result(
        table(
            "verdict", [verdict("fail", **names), verdict("unknown", **names), verdict("pass", near_miss=True, **names)]
        ),
        table("finding", [finding(**names)]),
        table(
            "drive",
            [
                drive(
                    NASTY,
                    file_name=NASTY,
                    format=NASTY,
                    map_name=NASTY,
                    sha256=NASTY,
                    map_sha256=NASTY,
                    quality=[check],
                    not_judged=[{"ego_id": NASTY, "signal": NASTY, "reason": NASTY}],
                ),
                drive("lost", status="not_judged", status_reason=NASTY, file_name=NASTY),
            ],
        ),
        table(
            "rule",
            [
                rule(
                    title=NASTY,
                    clause=NASTY,
                    hypothesis=NASTY,
                    unit=NASTY,
                    profiles=[NASTY],
                    requires=[NASTY],
                    params=[{"name": NASTY, "value": NASTY, "unit": NASTY, "overridden": True}],
                )
            ],
        ),
        table(
            "scene",
            [
                {
                    "drive_id": NASTY,
                    "ego_id": NASTY,
                    "t_ns": 108 * SECOND,
                    "environment_id": NASTY,
                    "reach_m": 60.0,
                    "lanelets": [NASTY],
                    "actors": [actor, actor | {"actor_id": NASTY + "2", "x_m": 9.0}],
                }
            ],
        ),
        table(
            "lane_shape",
            [
                {
                    "environment_id": NASTY,
                    "lanelet_id": NASTY,
                    "lane_type": NASTY,
                    "drivable": True,
                    "in_junction": False,
                    **shape,
                }
            ],
        ),
    )


def test_markup_in_names_stays_text() -> None:
    plain = Parsed(page(result([verdict("pass")])))
    parsed = Parsed(page(nasty()))
    assert parsed.text.count(NASTY) > 20
    assert sum(tag == "script" for tag, _ in parsed.tags) == sum(tag == "script" for tag, _ in plain.tags) == 1
    assert not [tag for tag, _ in parsed.tags if tag == "img"]
    assert not [name for _, attrs in parsed.tags for name in attrs if name.startswith("on")]
    ids = parsed.all("id")
    assert all(re.fullmatch(r"[A-Za-z][\w.-]*", name) for name in ids)


def test_the_policy_allows_our_style_and_script_and_nothing_from_outside(text: str) -> None:
    parsed = Parsed(text)
    (policy,) = [
        a["content"] for t, a in parsed.tags if t == "meta" and a.get("http-equiv") == "Content-Security-Policy"
    ]
    assert policy is not None
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    for tag in ("style", "script"):
        (body,) = re.findall(rf"<{tag}>(.*?)</{tag}>", text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(body.encode()).digest()).decode()
        assert f"{tag}-src 'sha256-{digest}'" in policy
    assert not parsed.all("style")
    assert not parsed.all("src")
    assert all(link.startswith(("#", "data:,")) for link in parsed.all("href"))
    assert not re.search(r"(?:https?:)?//[a-z]|@import|url\((?!#)", text)


def test_the_same_result_gives_the_same_bytes(overtakes: Result, text: str) -> None:
    def pieces(rows: pa.Table) -> pa.Table:
        return pa.concat_tables([rows.slice(0, 1), rows.slice(1)])

    again = Result(
        pieces(overtakes.verdicts),
        pieces(overtakes.findings),
        pieces(overtakes.drives),
        pieces(overtakes.rules),
        *(pieces(getattr(overtakes, name)) for name in list(FILES)[4:]),
    )
    assert page(again) == text


def test_every_finding_has_its_anchor_its_row_and_a_picture(overtakes: Result, text: str) -> None:
    parsed = Parsed(text)
    ids, links = parsed.all("id"), parsed.all("href")
    assert len(ids) == len(set(ids))
    for row in overtakes.findings.to_pylist():
        assert f"finding-{row['finding_id']}" in ids
        assert links.count(f"#finding-{row['finding_id']}") >= 2  # from the table and from the timeline
    assert {link[1:] for link in links if link.startswith("#")} <= set(ids)
    articles = re.findall(r"<article.*?</article>", text, re.DOTALL)
    assert len(articles) == overtakes.scenes.num_rows
    assert all('<svg class="plan"' in article and "b-ego" in article for article in articles)
    assert text.count('class="space') > 0


def test_a_page_of_a_typical_drive_is_small(text: str) -> None:
    assert len(text) < 500_000


def test_what_a_moment_says_is_what_was_measured(overtakes: Result, text: str) -> None:
    (row,) = [
        r for r in overtakes.findings.to_pylist()
        if r["drive_id"].startswith("collision") and r["profile"] == "relaxed" and "r162" in r["rule_id"]
    ]  # fmt: skip
    (block,) = re.findall(rf'id="finding-{row["finding_id"]}">(.*?)</div>', text, re.DOTALL)
    said = " ".join(re.sub(r"<[^>]+>", " ", block).split())
    assert f"{row['observed']:.2f} m must be more than {row['required']:.2f} m missed by {-row['margin']:.2f} m" in said


def test_unknown_is_told_with_its_reason_and_never_as_a_pass() -> None:
    rows = [
        verdict("unknown", reason="no map: give one", t_ref_ns=None, t_start_ns=None, t_end_ns=None, t_worst_ns=None)
    ]
    parsed = Parsed(page(result(rows)))
    assert "Nothing could be decided" in parsed.text
    assert "no map: give one" in parsed.text
    assert "No rule was broken" not in parsed.text


def test_the_headline() -> None:
    def headline(run: Result) -> str:
        (found,) = re.findall(r"<h1>(.*?)</h1>", page(run), re.DOTALL)
        return re.sub(r"<[^>]+>", "", found).strip()

    assert headline(result([verdict("pass")])) == "No finding"
    assert headline(result([verdict("pass"), verdict("unknown")])) == "No finding, as far as it could be judged"
    lost = [drive("d2", status="not_judged", status_reason="broken")]
    assert headline(result([verdict("pass")], drives=[drive(), *lost])) == "No finding, as far as it could be judged"
    assert headline(result([], drives=lost)) == "Nothing was judged"
    assert headline(result([verdict("fail")], [finding()])) == "1 finding in 1 of 1 drives"


def test_a_crowd_is_cut_to_the_worst_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    from drivelint.report.html import page as module

    monkeypatch.setattr(module, "MAX_FINDINGS", 3)
    monkeypatch.setattr(module, "MAX_DRIVES", 1)
    rows: list[dict[str, Any]] = [
        finding(drive_id=f"d{k}", severity="critical" if k == 7 else "minor", t_worst_ns=(108 + k) * SECOND)
        for k in range(9)
    ]
    run = result([verdict("fail")], rows, drives=[drive(f"d{k}") for k in range(9)])
    parsed = Parsed(page(run))
    assert sum(name.startswith("finding-") for name in parsed.all("id")) <= 3
    assert "The 3 most severe are shown" in parsed.text
    assert "Another 8 drives have no section here" in parsed.text
    assert f"finding-d7-{rows[7]['rule_id']}-nominal-0" in parsed.all("id")
    links = {link[1:] for link in parsed.all("href") if link.startswith("#")}
    assert links <= set(parsed.all("id"))


def test_a_result_read_back_gives_the_same_page(overtakes: Result, text: str, tmp_path: Path) -> None:
    write(overtakes, tmp_path)
    assert page(load(tmp_path)) == text


def test_the_command_writes_the_page_into_the_folder(overtakes: Result, text: str, tmp_path: Path) -> None:
    write(overtakes, tmp_path)
    command = [sys.executable, "-m", "drivelint", "report", str(tmp_path), "--to", "html"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.strip()) == (0, str(tmp_path / "report.html"))
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == text
    done = subprocess.run([*command[:4], str(tmp_path / "absent")], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("drivelint: error: ")
    assert len(done.stderr.splitlines()) == 1


def test_a_folder_without_a_result_is_one_clear_error(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no result of drivelint check"):
        load(tmp_path)
    write(result([verdict("pass")]), tmp_path)
    (tmp_path / "findings.parquet").write_bytes(b"cut")
    with pytest.raises(UsageError, match=r"findings\.parquet: cannot be read"):
        load(tmp_path)
    (tmp_path / "summary.json").write_text('{"output_schema": 99, "fail_on": "never", "strict": false}')
    with pytest.raises(UsageError, match="output schema 99"):
        load(tmp_path)
