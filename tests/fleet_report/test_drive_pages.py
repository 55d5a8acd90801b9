"""The pages of single drives: what they say is in the tables, no link is dead, and none stays from an earlier report."""

from __future__ import annotations

import json
import shutil
from collections import Counter
from pathlib import Path
from typing import Any

import duckdb
import pyarrow.parquet as pq
import pytest
from lxml import html

from drivelint.audit.compact import RECEIPT_SCHEMA
from drivelint.audit.store import LocalFolder
from drivelint.audit.unpacked import AuditProgress
from drivelint.fleet_report import content as content_
from drivelint.fleet_report import drive_pages, moment_pages
from drivelint.fleet_report.audit_views import Audit, open_audits
from drivelint.result.counts import one_finding_per_event
from tests.fleet import audits
from tests.fleet.audits import drive_finding, drive_verdict, ego_drive
from tests.fleet_report import lake
from tests.fleet_report.command import ran
from tests.report.synthetic import rule

pytestmark = pytest.mark.ci

SEVERITIES = ("critical", "major", "minor")


@pytest.fixture(scope="module")
def lake_copy(filled: lake.Lake, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the audit, as other tests write pages into it."""
    copy = tmp_path_factory.mktemp("pages") / "audit"
    shutil.copytree(filled.folder, copy, ignore=lambda folder, _: ["drives"] if folder == str(filled.folder) else [])
    return copy


@pytest.fixture(scope="module")
def ten(lake_copy: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy with the pages of the ten worst drives; no test writes other pages into it."""
    copy = tmp_path_factory.mktemp("ten") / "audit"
    shutil.copytree(lake_copy, copy, ignore=lambda folder, _: ["drives"] if folder == str(lake_copy) else [])
    assert ran("report", copy, "--drive-pages", 10).code == 0
    return copy


@pytest.fixture
def own_ten(ten: Path, tmp_path: Path) -> Path:
    """Return such a copy of a test's own."""
    return tmp_path / shutil.copytree(ten, tmp_path / "audit").name


def table(audit: Path, name: str) -> list[dict[str, Any]]:
    rows: list[dict[str, Any]] = pq.read_table(audit / "tables" / name).to_pylist()
    return rows


def pages_in(audit: Path) -> set[str]:
    return {f"drives/{file.name}" for file in (audit / "drives").glob("*.html")}


def parsed(file: Path) -> Any:
    return parsed_bytes(file.read_bytes())


def parsed_bytes(page: bytes) -> Any:
    return html.fromstring(page)


def links_of(audit: Path) -> list[str]:
    links: list[str] = parsed(audit / "fleet.html").xpath("//a/@href")
    return [link for link in links if not link.startswith("#")]


def words(element: Any) -> str:
    return " ".join(element.text_content().split())


def worst_keys(audit: Path) -> list[str]:
    """Return the keys of the drives with findings, the worst first, by a count of my own."""
    log = {row["key"]: row["log"] for row in table(audit, "drives")}
    counted: dict[str, Counter[str]] = {}
    for row in table(audit, "findings"):
        counted.setdefault(row["key"], Counter())[row["severity"]] += 1
    return sorted(counted, key=lambda key: (*(-counted[key][name] for name in SEVERITIES), log[key]))


def test_the_worst_drives_have_pages_and_the_others_no_dead_link(ten: Path) -> None:
    due = [drive_pages.page_name(key) for key in worst_keys(ten)[:10]]
    assert links_of(ten) == due
    assert pages_in(ten) == set(due)
    assert json.loads((ten / "drives" / "pages.json").read_bytes()) == {"written_by_drivelint": sorted(due)}
    rows = parsed(ten / "fleet.html").xpath("//div[contains(@class, 'worst-table')]//tbody/tr")
    assert [bool(row.xpath("./th/a")) for row in rows] == [True] * 10 + [False] * 40


def test_a_page_says_what_the_tables_say(ten: Path) -> None:
    for key in worst_keys(ten)[:3]:
        page = parsed(ten / drive_pages.page_name(key))
        (drive,) = [row for row in table(ten, "drives") if row["key"] == key]
        findings = [row for row in table(ten, "findings") if row["key"] == key]
        verdicts = Counter(row["verdict"] for row in table(ten, "verdicts") if row["key"] == key)
        n = Counter(row["severity"] for row in one_finding_per_event(findings))
        said = ", ".join(f"{n[name]} {name}" for name in SEVERITIES if n[name])
        assert words(page.xpath("//h1")[0]) == f"{said} findings in {drive['drive_id']}"
        for word in ("pass", "fail", "unknown", "not_applicable", "error"):
            assert f"{verdicts[word]} {word.replace('_', ' ')}" in words(page.find(".//header"))
        facts = words(page.xpath("//dl")[0])
        for value in (drive["log"], drive["sha256"], drive["map_sha256"], key, *dict(drive["tags"]).values()):
            assert value in facts
        rows = page.xpath("//section[@aria-labelledby='findings']//tbody/tr")
        assert {words(row.xpath(".//td//code")[0]) for row in rows} == {row["finding_id"] for row in findings}
        order = [SEVERITIES.index(row.xpath("string(./td[1]/span)")) for row in rows]
        assert order == sorted(order)
        assert "-1.00" in words(rows[0].xpath("./td[@data-label='margin']")[0])
        assert f"drivelint check {drive['log']} --map town.xodr --out drives/{drive['drive_id']}" in words(page)
        assert set(page.xpath("//a/@href")) - {"#data", "#main"} == {"../fleet.html"}


@pytest.mark.slow
def test_unknown_verdicts_are_grouped_by_reason(lake_copy: Path) -> None:
    verdicts = [row for row in table(lake_copy, "verdicts") if row["verdict"] == "unknown"]
    assert ran("report", lake_copy, "--drive-pages", "all").code == 0
    key = verdicts[0]["key"]
    n = Counter(row["reason_code"] for row in verdicts if row["key"] == key)
    page = parsed(lake_copy / drive_pages.page_name(key))
    rows = page.xpath("//section[@aria-labelledby='undecided']//tbody/tr")
    assert {words(row[0]).partition(" no ")[0]: int(words(row[1])) for row in rows} == {
        code.replace("_", " "): count for code, count in n.items()
    }
    assert "indicator: no indicators" in words(page.xpath("//section[@aria-labelledby='data']")[0])


@pytest.mark.slow
def test_all_are_all_drives_of_the_audit(lake_copy: Path) -> None:
    drives = table(lake_copy, "drives")
    assert ran("report", lake_copy, "--drive-pages", "all").code == 0
    assert pages_in(lake_copy) == {drive_pages.page_name(row["key"]) for row in drives}
    assert all((lake_copy / link).is_file() for link in links_of(lake_copy))
    (lost, *_) = [row for row in drives if row["status"] != "judged"]
    assert drive_pages.page_name(lost["key"]) in links_of(lake_copy)
    page = parsed(lake_copy / drive_pages.page_name(lost["key"]))
    assert words(page.xpath("//h1")[0]) == f"Could not be judged: {lost['drive_id']}"
    assert lost["status_reason"] in words(page.find(".//header"))


@pytest.mark.slow
def test_pages_of_an_earlier_report_are_removed_and_nothing_else(own_ten: Path) -> None:
    kept = [own_ten / "drives" / "notes.html", own_ten / "drives" / f"{'a' * 64}.html", own_ten / "summary.json"]
    for file in kept[:2]:
        file.write_text("mine", encoding="utf-8")
    listed = own_ten / "drives" / "pages.json"
    told = json.loads(listed.read_bytes())
    told["written_by_drivelint"] += ["summary.json", "drives/../summary.json", "drives/notes.html", "/etc/hostname"]
    listed.write_text(json.dumps(told), encoding="utf-8")
    assert ran("report", own_ten, "--drive-pages", 2).code == 0
    assert len(pages_in(own_ten)) == 2 + 2
    assert ran("report", own_ten, "--drive-pages", 0).code == 0
    assert pages_in(own_ten) == {f"drives/{file.name}" for file in kept[:2]}
    assert not listed.exists()
    assert links_of(own_ten) == []
    assert all(file.is_file() for file in kept)
    for file in kept[:2]:
        file.unlink()


@pytest.mark.slow
def test_a_report_that_ends_early_leaves_a_list_of_all_that_is_there(
    own_ten: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = pages_in(own_ten)

    def broken(*_: object) -> Any:
        yield drive_pages.page_name("new"), b"new"
        raise RuntimeError

    monkeypatch.setattr(drive_pages, "pages", broken)
    monkeypatch.setattr(drive_pages, "choose_drives_and_return_page_names", lambda *_: [drive_pages.page_name("new")])
    monkeypatch.setattr(moment_pages, "worst_drives", lambda *_: [])
    with pytest.raises(RuntimeError):
        ran("report", own_ten)
    monkeypatch.undo()
    assert pages_in(own_ten) == {*before, drive_pages.page_name("new")}
    assert ran("report", own_ten, "--drive-pages", 3).code == 0
    assert pages_in(own_ten) == {drive_pages.page_name(key) for key in worst_keys(own_ten)[:3]}


@pytest.mark.slow
def test_the_same_audit_gives_the_same_bytes(lake_copy: Path) -> None:
    assert pages_by_name(lake_copy, 20) == pages_by_name(lake_copy, 20)


@pytest.mark.slow
def test_more_pages_take_no_more_statements_and_do_not_change(lake_copy: Path) -> None:
    few, many = StatementCounter(), StatementCounter()
    assert pages_by_name(lake_copy, 3, few).items() <= pages_by_name(lake_copy, 90, many).items()
    assert few.n == many.n < 12


class StatementCounter:
    """Counts the statements that go to a database."""

    def __init__(self) -> None:
        self.con: Any = None
        self.n = 0

    def execute(self, *arguments: Any) -> Any:
        self.n += 1
        return self.con.execute(*arguments)


def pages_by_name(audit: Path, max_drives: int, counter: StatementCounter | None = None) -> dict[str, bytes]:
    with open_audits(str(audit)) as (con, told, _):
        found = content_.fleet_content(con, told, None, ())
        through: Any = con
        if counter is not None:
            counter.con, through = con, counter
        drive_pages.choose_drives_and_return_page_names(through, max_drives)
        return dict(drive_pages.pages(through, told, found.rules))


def test_a_page_tells_what_was_lost_what_is_only_possible_and_what_could_not_be_run() -> None:
    note = {
        "check_id": "gap",
        "severity": "warning",
        "actor_id": None,
        "n": 1,
        "t_first_ns": 0,
        "message": "3 chunks were lost",
    }
    lack = {"ego_id": "1", "signal": "brake_light", "reason_code": "missing_brake_light", "reason": "no brake lights"}
    drives = [
        ego_drive("a", lossy=True, quality=[note], not_judged=[lack], sha256="same"),
        ego_drive("b", sha256="same"),
    ]
    verdicts = [
        drive_verdict("a", "fail"),
        drive_verdict("a", "error", rule_id="z-contact", reason_code="rule_timeout", reason="took 31 s"),
    ]
    rules = [rule(profiles=[], status="draft"), rule("z-contact", profiles=[])]
    with duckdb.connect() as con:
        audits.add_rows(
            con, drives, verdicts, [drive_finding("a", n_copies=100, n_stays=40, t_start_s=1.0, t_worst_s=1.0)], rules
        )
        con.register("receipts", RECEIPT_SCHEMA.empty_table())
        audit = Audit("out", LocalFolder(Path("out")), {"settings": {}}, AuditProgress("d"))
        told = content_.fleet_content(con, audit, None, ())
        assert drive_pages.choose_drives_and_return_page_names(con, None) == [
            drive_pages.page_name("a"),
            drive_pages.page_name("b"),
        ]
        made = dict(drive_pages.pages(con, audit, told.rules))
    lossy, whole = (parsed_bytes(made[drive_pages.page_name(key)]) for key in "ab")
    assert "Lossy: parts of the log were lost" in words(lossy.find(".//header"))
    assert "Lossy" not in words(whole)
    data = words(lossy.xpath("//section[@aria-labelledby='data']")[0])
    assert "warning 3 chunks were lost" in data
    assert "missing brake light: no brake lights" in data
    (finding,) = lossy.xpath("//section[@aria-labelledby='findings']//tbody/tr")
    assert "possible, in 40 of 100 copies" in words(finding)
    assert "draft" in words(finding[0])
    (open_,) = lossy.xpath("//section[@aria-labelledby='undecided']//tbody/tr")
    assert [words(cell) for cell in open_[:2]] == ["rule timeout error", "1"]
    assert "1 other log of the audit" in words(lossy)
    assert words(whole.xpath("//h1")[0]) == "Nothing could be decided: b"


def test_an_overtake_under_two_profiles_counts_once_as_on_the_fleet_page() -> None:
    twice = [drive_finding("a", profile=profile, finding_id=profile) for profile in ("nominal", "observed")]
    for row in twice:
        row |= {"t_start_s": 1.0, "t_worst_s": 1.0}
    with duckdb.connect() as con:
        audits.add_rows(
            con,
            [ego_drive("a")],
            [drive_verdict("a", "fail", profile=row["profile"]) for row in twice],
            twice,
            [rule()],
        )
        con.register("receipts", RECEIPT_SCHEMA.empty_table())
        audit = Audit("out", LocalFolder(Path("out")), {"settings": {}}, AuditProgress("d"))
        told = content_.fleet_content(con, audit, None, ())
        drive_pages.choose_drives_and_return_page_names(con, None)
        ((_, made),) = drive_pages.pages(con, audit, told.rules)
    page = parsed_bytes(made)
    assert [row["critical"] for row in told.worst] == [1]
    assert words(page.xpath("//h1")[0]) == "1 critical finding in a"
    section = page.xpath("//section[@aria-labelledby='findings']")[0]
    assert words(section.xpath("./h2")[0]) == "Findings 1"
    assert words(section.xpath("./p")[0]) == "2 rows, 1 finding: an overtake under two profiles counts once."
    assert len(section.xpath(".//tbody/tr")) == 2


def test_a_name_holds_nothing_of_a_key_that_is_no_hash() -> None:
    assert drive_pages.page_name("0a" * 32) == f"drives/{'0a' * 32}.html"
    for key in ("", "../../x", "A" * 64, "0a" * 33, "a/b\0\n'\"<", "\udcff"):
        name = drive_pages.page_name(key)
        assert drive_pages.is_page_name(name)
        assert key not in name or not key
    assert not drive_pages.is_page_name(f"drives/{'0a' * 32}.html\n")


@pytest.mark.slow
def test_markdown_leaves_the_pages_as_they_are(ten: Path) -> None:
    before = {file: file.read_bytes() for file in (ten / "drives").iterdir()}
    assert ran("report", ten, "--to", "markdown").code == 0
    assert {file: file.read_bytes() for file in (ten / "drives").iterdir()} == before
    assert "drives/0" not in (ten / "fleet.md").read_text(encoding="utf-8").replace("--out drives/", "")


@pytest.mark.slow
def test_the_baseline_leads_to_the_pages(lake_copy: Path, tmp_path: Path) -> None:
    base = lake.write(tmp_path / "base", 1_200)
    found = pq.read_table(base.folder / "tables" / "findings")
    key = worst_keys(lake_copy)[0]
    shutil.rmtree(base.folder / "tables" / "findings")
    (base.folder / "tables" / "findings").mkdir()
    pq.write_table(
        duckdb.from_arrow(found).filter(f"key <> '{key}'").to_arrow_table(),
        base.folder / "tables" / "findings" / "00000000.parquet",
    )
    lake.seal_anew(base.folder)
    assert ran("report", lake_copy, "--baseline", base.folder, "--drive-pages", 1).code == 0
    since = parsed(lake_copy / "fleet.html").xpath("//section[@aria-labelledby='since']")[0]
    assert set(since.xpath(".//li/a/@href")) == {drive_pages.page_name(key)}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--drive-pages", "some"), "write a number such as 100, or all"),
        (("--drive-pages", "-1"), "write a number such as 100, or all"),
        (("--drive-pages", "5", "--to", "markdown"), "are for --to html"),
    ],
)
def test_mistakes_are_told(lake_copy: Path, options: tuple[str, ...], message: str) -> None:
    done = ran("report", lake_copy, *options)
    assert done.code == 2
    assert message in done.err


def test_drive_pages_are_of_audits_only(tmp_path: Path) -> None:
    done = ran("report", tmp_path, "--drive-pages", "5")
    assert done.code == 2
    assert "is not an audit" in done.err
