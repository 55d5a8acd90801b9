"""`drivelint report` of an audit: its numbers are those of the tables, counted otherwise, and nothing grows with the drives."""

from __future__ import annotations

import re
import shlex
from collections import Counter
from pathlib import Path
from typing import Any

import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest
from lxml import html

from drivelint.fleet_report import content as content_
from drivelint.fleet_report import page
from drivelint.fleet_report.audit_views import open_audits
from drivelint.result.counts import SEVERITIES
from tests.audit import fleet
from tests.audit.here import run_audit
from tests.fleet_report import lake
from tests.fleet_report.command import ran
from tests.fleet_report.conftest import Audited


@pytest.fixture(scope="module")
def fleet_html(filled: lake.Lake, audited: Audited) -> Any:
    done = ran("report", filled.folder, "--by", "site", "--by", "vehicle")
    assert (done.code, done.out.strip()) == (0, f"{filled.folder}/fleet.html")
    return page_of(filled.folder)


def page_of(audit: Path) -> Any:
    return html.fromstring((audit / "fleet.html").read_bytes())


def table(of: Path, name: str) -> dict[str, list[object]]:
    rows: dict[str, list[object]] = pq.read_table(of / "tables" / name).to_pydict()
    return rows


def section(fleet_html: Any, name: str) -> Any:
    (found,) = fleet_html.xpath(f"//section[@aria-labelledby='{name}']")
    return found


def rows(of: Any, n: int = 0) -> list[dict[str, str]]:
    """Return the rows of a table as head -> the words of the cell."""
    found = of.xpath(".//table")[n]
    heads = ["".join(each.itertext()).strip() for each in found.xpath("./thead//th")]
    return [
        dict(zip(heads, (" ".join(" ".join(cell.itertext()).split()) for cell in row), strict=True))
        for row in found.xpath("./tbody/tr")
    ]


@pytest.mark.ci
def test_the_headline_counts_what_the_tables_have(fleet_html: Any, filled: lake.Lake) -> None:
    found = table(filled.folder, "findings")
    n = [found["severity"].count(severity) for severity in ("critical", "major", "minor")]
    assert sum(n) == filled.n_findings
    (head,) = fleet_html.xpath("//h1")
    n_judged = table(filled.folder, "drives")["status"].count("judged")
    assert n_judged == 1200 - filled.n_not_judged
    told = f"{n[0]:,} critical, {n[1]:,} major, {n[2]:,} minor findings in {len(set(found['key'])):,}"
    said = f"{told} of {n_judged:,} judged drives"
    assert head.text_content().strip() == said
    assert f"{filled.n_not_judged} could not be judged" in fleet_html.xpath("//header")[0].text_content()


@pytest.mark.ci
def test_a_rate_is_that_of_the_wholly_judged_drives(fleet_html: Any, filled: lake.Lake) -> None:
    """Against a sum of my own over the tables, and the interval from the chi-square distribution."""
    from scipy.stats import chi2

    told = {row["rule"].split()[-1]: row for row in rows(section(fleet_html, "rates"))}
    drives, verdicts = table(filled.folder, "drives"), table(filled.folder, "verdicts")
    km = dict(zip(drives["key"], drives["km"], strict=True))
    findings = table(filled.folder, "findings")["rule_id"]
    rules = pq.read_table(filled.folder / "rules.parquet").to_pydict()
    asked = [name for name, profiles in zip(rules["rule_id"], rules["profiles"], strict=True) if not profiles]
    n_with_findings = n_partly = 0
    for name in asked:
        said = [
            (key, v)
            for key, r, v in zip(verdicts["key"], verdicts["rule_id"], verdicts["verdict"], strict=True)
            if r == name
        ]
        way = sum(km[key] for key, verdict in said if verdict != "unknown") / 100  # type: ignore[misc]
        n = findings.count(name)
        if not way:
            continue
        low = chi2.ppf(0.025, 2 * n) / 2 / way if n else 0.0
        high = chi2.ppf(0.975, 2 * n + 2) / 2 / way
        numbers = [float(x.replace(",", "")) for x in re.findall(r"[\d.,]+", told[name]["per 100 km"])]
        assert numbers == pytest.approx([n / way, low, high], rel=0.006)
        unknown = sum(verdict == "unknown" for _, verdict in said)
        assert told[name]["unknown"] == (f"{unknown:,}" if unknown else "·")
        n_with_findings += n > 0
        n_partly += unknown > 0
    assert n_with_findings > 10
    assert n_partly > 5


@pytest.mark.ci
def test_rules_with_findings_come_first_and_by_severity(fleet_html: Any) -> None:
    told = rows(section(fleet_html, "rates"))
    order = [(row["findings"] == "0", ["critical", "major", "minor"].index(row["severity"].split()[0])) for row in told]
    assert order == sorted(order)


@pytest.mark.ci
def test_the_worst_drive_is_first_and_what_is_left_out_is_counted(fleet_html: Any, filled: lake.Lake) -> None:
    worst = section(fleet_html, "worst-drives")
    told = rows(worst)
    assert len(told) == content_.MAX_DRIVES_PER_TABLE
    assert filled.worst_log in told[0]["drive"]
    assert int(told[0]["critical"]) >= lake.WORST
    left = len(set(table(filled.folder, "findings")["key"])) - content_.MAX_DRIVES_PER_TABLE
    assert f"{left:,} more drives have findings" in worst.text_content()


@pytest.mark.ci
def test_tags_have_a_table_per_rule_and_rare_values_are_counted(fleet_html: Any, filled: lake.Lake) -> None:
    site, vehicle = section(fleet_html, "by-1"), section(fleet_html, "by-2")
    assert [row["site"] for row in rows(site)] == ["hull", "leeds", "york"]
    assert len(rows(vehicle)) == 12
    assert "85 values of vehicle that fewer drives have are left out" in " ".join(vehicle.text_content().split())
    n = sum(int(row["findings"].split()[0].replace(",", "")) for row in rows(site))
    found = list(zip(*(table(filled.folder, "findings")[name] for name in ("rule_id", "severity")), strict=True))
    # the gravest rule stands first; of several, the one with the most findings
    gravest, most = max(Counter(found).items(), key=lambda each: (-SEVERITIES.index(each[0][1]), each[1]))
    assert gravest[1] == SEVERITIES[0]
    assert n == most


@pytest.mark.ci
def test_what_is_missing_says_what_it_would_decide(fleet_html: Any, filled: lake.Lake) -> None:
    (signal,) = rows(section(fleet_html, "open"))
    rules = pq.read_table(filled.folder / "rules.parquet").to_pydict()
    needing = {
        name for name, requires in zip(rules["rule_id"], rules["requires"], strict=True) if "indicator" in requires
    }
    verdicts = pq.read_table(filled.folder / "tables" / "verdicts")
    unknown = verdicts.filter(pc.equal(verdicts["verdict"], "unknown")).to_pydict()
    hit = [(key, rule) for key, rule in zip(unknown["key"], unknown["rule_id"], strict=True) if rule in needing]
    assert signal["signal"] == "indicator"
    assert signal["judgements"] == f"{len(set(hit)):,}"
    assert int(signal["drives"].replace(",", "")) == len({key for key, _ in hit}) > 100
    lost = rows(section(fleet_html, "open"), 1)
    assert len(lost) == filled.n_not_judged
    assert all("cannot be read" in row["why"] for row in lost)


@pytest.mark.ci
def test_the_map_shows_every_finding_or_says_how_many_not(fleet_html: Any, filled: lake.Lake) -> None:
    marks = section(fleet_html, "map").xpath(".//circle/title/text()")
    drawn = sum(int(mark.replace(",", "")) for mark in marks)
    said = re.search(r"([\d,]+) findings in cells with few are not drawn", section(fleet_html, "map").text_content())
    assert drawn + (int(said[1].replace(",", "")) if said else 0) == filled.n_findings
    xs = sorted(float(x) for x in section(fleet_html, "map").xpath(".//circle/@cx"))
    assert xs[0] < 100
    assert xs[-1] > 800  # Leeds in the west, Hull in the east


@pytest.mark.slow
def test_the_same_audit_gives_the_same_bytes(filled: lake.Lake) -> None:
    made = []
    for _ in range(2):
        with open_audits(str(filled.folder)) as (con, audit, _base):
            found = content_.fleet_content(con, audit, None, ["release"])
        made.append((page.html(found), page.markdown(found)))
    assert made[0] == made[1]


@pytest.mark.slow
def test_markdown_has_the_same_rates(filled: lake.Lake, fleet_html: Any) -> None:
    done = ran("report", filled.folder, "--to", "markdown")
    assert done.code == 0
    text = (filled.folder / "fleet.md").read_text(encoding="utf-8")
    told = [row for row in rows(section(fleet_html, "rates")) if row["findings"] != "0"]
    assert len(told) > 10
    for row in told:
        assert f"`{row['rule'].split()[-1]}` | {row['severity']} | {row['findings'].replace(',', '')} |" in text


@pytest.mark.slow
def test_the_command_of_the_worst_drive_opens_it(
    audited: Audited, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran("report", audited.base)
    written = page_of(audited.base)
    first = section(written, "worst-drives").xpath(".//code[@class='command']")[0]
    monkeypatch.chdir(tmp_path)
    program, *words = shlex.split(first.text_content())
    assert program == "drivelint"
    assert ran(*words, "--quiet").code == 1, "the planted contact is found again"
    assert (tmp_path / words[-1] / "report.html").is_file()


@pytest.mark.slow
def test_a_fleet_without_findings_is_no_pass_if_something_could_not_be_judged(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3, seed=1)
    log = min((tmp_path / "fleet" / "logs").iterdir())
    out = tmp_path / "out"
    run_audit(few, out)
    assert not few.planted
    ran("report", out)
    assert page_of(out).xpath("//h1")[0].text_content().strip() == "No finding"
    log.write_bytes(log.read_bytes()[:100])
    run_audit(few, out)
    ran("report", out)
    written = page_of(out)
    assert written.xpath("//h1")[0].text_content().strip() == "No finding, but not everything could be judged"
    assert log.name in section(written, "open").text_content()


@pytest.mark.slow
def test_an_audit_that_has_not_ended_is_not_told_as_whole(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3)
    out = tmp_path / "out"
    run_audit(few, out, shard=(1, 1))
    done = ran("report", out)
    assert "3 judged drives are not packed yet" in done.err
    assert "Not complete" in page_of(out).text_content()


@pytest.mark.slow
def test_a_baseline_says_what_is_new(audited: Audited) -> None:
    ran("report", audited.new, "--baseline", audited.base)
    since = section(page_of(audited.new), "since")
    new = audited.new_fleet.planted - audited.base_fleet.planted
    assert f"{len(new)} new" in since.text_content()
    (listed,) = [each for each in since.xpath(".//details") if each.xpath("./summary[starts-with(., 'New')]")]
    assert {title.rpartition("/")[2] for title in listed.xpath(".//li/@title")} == new


@pytest.mark.slow
def test_the_page_does_not_grow_with_the_drives(filled: lake.Lake, fleet_html: Any, tmp_path: Path) -> None:
    more = lake.write(tmp_path / "more", 4 * filled.n_drives)
    ran("report", more.folder, "--by", "site", "--by", "vehicle")
    few, many = ((each.folder / "fleet.html").stat().st_size for each in (filled, more))
    marks = 80 * 3_000  # the map has more of them, at most 3,000
    assert many < 1.1 * few + marks
    assert marks < 0.03 * 10_000_000


@pytest.mark.slow
def test_a_page_of_100_000_drives_opens(tmp_path: Path) -> None:
    large = lake.write(tmp_path / "large", 100_000)
    assert ran("report", large.folder, "--by", "site", "--by", "vehicle").code == 0
    assert (large.folder / "fleet.html").stat().st_size < 10_000_000


@pytest.mark.ci
@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--to", "xqar"), "an audit can be reported as html, markdown, junit, sarif"),
        (("--by", "sit"), "did you mean 'site'?"),
        (("--incident", "x"), "are only for a check"),
        (("--baseline", "nowhere"), "no audit is here"),
    ],
)
def test_mistakes_are_told(filled: lake.Lake, words: tuple[str, ...], message: str) -> None:
    done = ran("report", filled.folder, *words)
    assert done.code == 2
    assert message in done.err


def test_tags_are_of_audits_only(tmp_path: Path) -> None:
    done = ran("report", tmp_path, "--by", "site")
    assert done.code == 2
    assert "is not an audit" in done.err
