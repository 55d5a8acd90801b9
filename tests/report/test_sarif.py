"""SARIF: findings as code scanning reads them; what could not be judged is never a result."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import date
from typing import TYPE_CHECKING, Any

import pytest

from drivelint.gate import Gate, GateInputs, Waiver
from drivelint.report import sarif
from drivelint.result import request
from drivelint.result.request import RunRequest
from drivelint.run import CheckOptions
from tests.report.synthetic import SDA, SECOND, drive, finding, result, rule, verdict
from tests.shared_data import shared

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.result.model import Result

MIXED = [
    verdict("pass", profile="aggressive"),
    verdict("fail"),
    verdict("unknown", profile="observed", reason="the oncoming vehicle was lost"),
    verdict("unknown", profile="observed", occurrence=1, reason="the oncoming vehicle was lost"),
    verdict("not_applicable", profile="relaxed"),
]


def log(run: Result) -> dict[str, Any]:
    told: dict[str, Any] = json.loads(sarif.render(run))
    (only,) = told["runs"]
    return dict(only)


def gated(*rows: dict[str, Any], base: list[dict[str, Any]] | None = None) -> Result:
    waiver = Waiver("w:1", "*", "ticket 17", "jo", "2027-01-31", object="3")
    expired = Waiver("w:9", "*", "old", "al", "2026-01-31")
    baseline = None if base is None else result([verdict("fail")], base)
    keeper = GateInputs(date(2026, 11, 20), baseline, waivers=(waiver, expired))
    return keeper.apply_to(result([verdict("fail")], list(rows)))


HOSTILE = result(
    [verdict("unknown", reason='<b>"&\x00{0}</b>'), verdict("error", drive_id="d3")],
    [finding(object_id="<x>\n", reason="{0} [x](y)", x_m=float("nan"), margin=float("-inf"), lanelet_id="7")],
    drives=[
        drive(file_name="C:\\ log #1%.csv", quality=[
            {"check_id": "c", "severity": s, "actor_id": None, "n": 1, "t_first_ns": None, "message": "m"}
            for s in ("info", "warning", "error")
        ]),
        drive("d2", status="not_judged", status_reason="no ego", sha256=None),
        drive("d3"),
    ],
    rules=[rule(params=[{"name": "p", "value": "1", "unit": None, "overridden": True}])],
)  # fmt: skip


@pytest.mark.parametrize(
    "run",
    [
        pytest.param(result([]), id="nothing"),
        pytest.param(result(MIXED, [finding()]), id="mixed"),
        pytest.param(HOSTILE, id="hostile"),
        pytest.param(
            replace(HOSTILE, run_options=RunRequest(relative_paths={"d1": "C:/\udcff log #1%/2.csv"})), id="named"
        ),
        pytest.param(gated(finding(), finding(object_id="4", finding_id="x"), base=[finding()]), id="gated"),
    ],
)
def test_the_log_is_valid_sarif(run: Result) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(shared("standards/sarif-schema-2.1.0.json").read_text(encoding="utf-8"))
    checker = jsonschema.validators.validator_for(schema)  # of the draft that the schema names
    checker.check_schema(schema)
    told = json.loads(sarif.render(run))
    assert [error.message for error in checker(schema, format_checker=checker.FORMAT_CHECKER).iter_errors(told)] == []
    del told["runs"][0]["tool"]["driver"]["name"]
    assert [error.message for error in checker(schema).iter_errors(told)] == ["'name' is a required property"]


def test_a_finding_is_a_result_with_its_place_and_its_id() -> None:
    (found,) = log(result(MIXED, [finding(x_m=1.5, y_m=-2.0, lanelet_id="117")]))["results"]
    assert (found["ruleId"], found["kind"], found["level"]) == (SDA, "fail", "error")
    name = f"d1-{SDA}-nominal-0"
    assert found["partialFingerprints"] == {"findingId/v1": name, "primaryLocationLineHash": name}
    assert found["message"]["text"].endswith("ego 1, object 3, profile nominal, 8.00 s")
    assert found["message"]["text"].startswith(
        "Not kept: room to overtake: because fail observed 58.00 m, required 64.00 m"
    )
    (place,) = found["locations"]
    assert place["physicalLocation"]["artifactLocation"] == {"uri": "d1.csv", "index": 0}
    assert [(part["kind"], part["name"]) for part in place["logicalLocations"]] == [
        ("drive", "d1"), ("ego", "1"), ("object", "3"), ("lanelet", "117"),
    ]  # fmt: skip
    assert place["message"]["text"] == "8.00 s into d1.csv, ego at x 1.50 m, y -2.00 m"
    said = found["properties"]
    assert (said["start_s"], said["end_s"], said["worst_s"]) == (8.0, 8.0, 8.0)
    assert (said["x_m"], said["y_m"], said["margin"], said["unit"], said["profile"]) == (
        1.5,
        -2.0,
        -6.0,
        "m",
        "nominal",
    )
    assert said["t_utc"] is None
    assert "baselineState" not in found
    assert "suppressions" not in found


def with_paths(run: Result, **paths: str) -> Result:
    return replace(run, run_options=RunRequest(relative_paths=paths))


def test_a_log_has_its_path_from_the_folder_of_the_check() -> None:
    """As code scanning needs it to find the file; a log outside that folder has its name alone."""
    drives = [drive(), drive("d2", file_name="a b.csv")]
    run = log(
        with_paths(result(MIXED, [finding(), finding(drive_id="d2")], drives=drives), d2="logs #1/wet:day/a b.csv")
    )
    assert "%SRCROOT%" in run["originalUriBaseIds"]
    first, second = (artifact["location"] for artifact in run["artifacts"])
    assert first == {"uri": "d1.csv"}
    assert second == {"uri": "logs%20%231/wet%3Aday/a%20b.csv", "uriBaseId": "%SRCROOT%"}
    places = [found["locations"][0]["physicalLocation"]["artifactLocation"] for found in run["results"]]
    assert places == [{**first, "index": 0}, {**second, "index": 1}]
    assert "originalUriBaseIds" not in log(result(MIXED, [finding()]))


def test_the_path_is_kept_with_the_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (work := tmp_path / "work").mkdir()
    monkeypatch.chdir(work)
    options = CheckOptions(traces=())
    asked = RunRequest.from_options(
        options, {"d2": "drives/../logs/b.csv", "d1": str(work / "a.csv"), "d3": "../c.csv"}
    )
    assert asked.relative_paths == {"d1": "a.csv", "d2": "logs/b.csv"}
    (tmp_path / "run.json").write_bytes(request.render(asked, tmp_path))
    monkeypatch.chdir(tmp_path)
    run = log(replace(result([verdict("fail")], [finding()]), folder=tmp_path))
    assert run["artifacts"][0]["location"] == {"uri": "a.csv", "uriBaseId": "%SRCROOT%"}


def test_a_finding_has_its_time_in_utc_where_the_log_has_one() -> None:
    """It is worst 8 s into the drive, which begins at 100 s of the log's clock and, here, at 1,700,000,000.25 s since 1970."""
    run = result(MIXED, [finding()], drives=[drive(utc_start_ns=1_700_000_000_250_000_000)])
    (found,) = log(run)["results"]
    assert found["properties"]["t_utc"] == "2023-11-14T22:13:28.250Z"


@pytest.mark.parametrize(
    ("severity", "status", "level"),
    [("critical", "stable", "error"), ("major", "stable", "warning"), ("minor", "stable", "note"), ("critical", "draft", "note")],
)  # fmt: skip
def test_the_level_is_the_severity_but_a_draft_is_a_note(severity: str, status: str, level: str) -> None:
    run = log(result([verdict("fail")], [finding(severity=severity)], rules=[rule(severity=severity, status=status)]))
    assert run["results"][0]["level"] == level
    assert run["tool"]["driver"]["rules"][0]["defaultConfiguration"]["level"] == level


def test_rules_come_with_help_and_with_counts_of_every_verdict() -> None:
    run = log(result(MIXED, [finding()], rules=[rule("ukhc.other"), rule()]))
    other, described = run["tool"]["driver"]["rules"]
    assert run["results"][0]["ruleIndex"] == 1
    assert described["shortDescription"]["text"] == "room to overtake"
    assert described["fullDescription"]["text"] == "is there room?"
    assert "Rule 162" in described["help"]["text"]
    counted = {"pass": 1, "fail": 1, "unknown": 2, "not_applicable": 1, "error": 0}
    assert described["properties"]["verdicts"] == counted == run["properties"]["verdicts"]
    assert set(other["properties"]["verdicts"].values()) == {0}


def test_what_could_not_be_judged_is_a_notification_never_a_result() -> None:
    run = log(result(MIXED, [finding()]))
    assert len(run["results"]) == 1
    (invocation,) = run["invocations"]
    (notice,) = invocation["toolExecutionNotifications"]
    assert notice["descriptor"]["id"] == "unknown"
    assert run["tool"]["driver"]["notifications"][notice["descriptor"]["index"]]["id"] == "unknown"
    assert notice["message"]["text"] == f"{SDA} [observed]: unknown: the oncoming vehicle was lost (2 times)"
    assert notice["associatedRule"] == {"id": SDA, "index": 0}
    assert (invocation["executionSuccessful"], invocation["exitCode"]) == (True, 1)


def test_errors_drives_that_were_not_judged_and_bad_data_are_told() -> None:
    run = log(HOSTILE)
    (invocation,) = run["invocations"]
    assert not invocation["executionSuccessful"]
    notices = [(n["descriptor"]["id"], n["level"]) for n in invocation["toolExecutionNotifications"]]
    assert notices == [
        ("not-judged", "error"), ("unknown", "warning"), ("error", "error"),
        ("data-quality", "note"), ("data-quality", "warning"), ("data-quality", "error"),
    ]  # fmt: skip
    assert [artifact["location"]["uri"] for artifact in run["artifacts"]] == [
        "C%3A%5C%20log%20%231%25.csv",
        "d2.csv",
        "d3.csv",
    ]
    assert ["hashes" in artifact for artifact in run["artifacts"]] == [True, False, True]
    assert run["results"][0]["properties"]["margin"] is None


def test_a_waived_finding_is_suppressed_with_its_reason() -> None:
    run = log(gated(finding(), finding(object_id="4", finding_id="x")))
    waived, other = run["results"]
    assert waived["suppressions"] == [
        {"kind": "external", "status": "accepted", "justification": "ticket 17 (jo, until 2027-01-31)"}
    ]
    assert other["suppressions"] == []
    assert [each["properties"]["gates"] for each in (waived, other)] == [False, True]
    assert [each["level"] for each in (waived, other)] == ["note", "error"]
    region = waived["locations"][0]["physicalLocation"]["region"]
    assert region == {"startLine": 1}
    notices = run["invocations"][0]["toolExecutionNotifications"]
    assert [n["message"]["text"] for n in notices] == [
        "w:9: expired 2026-01-31 (al): it has no effect; 2 findings match it"
    ]
    assert run["properties"]["gate"]["waived_findings"] == 1


def test_a_baseline_gives_each_result_its_state() -> None:
    late = finding(finding_id="late", t_start_ns=115 * SECOND, t_end_ns=115 * SECOND, t_worst_ns=115 * SECOND)
    odd = finding(object_id="4", finding_id="odd", margin=-9.0)
    run = log(gated(finding(), odd, late, base=[finding(), odd | {"margin": -1.0}]))
    assert [found["baselineState"] for found in run["results"]] == ["unchanged", "updated", "new"]
    free = finding(
        finding_id="free", object_id="5", t_start_ns=115 * SECOND, t_end_ns=115 * SECOND, t_worst_ns=115 * SECOND
    )
    run = log(gated(odd, free, base=[odd]))
    states = [(found["baselineState"], found["level"]) for found in run["results"]]
    assert states == [("unchanged", "note"), ("new", "error")]  # what is known does not gate


def test_a_finding_that_is_only_possible_under_the_asked_confidence_is_a_note() -> None:
    found = [finding(finding_id="sure"), finding(finding_id="possible", object_id="4")]
    run = log(replace(result([verdict("fail")], found), gate=Gate(confidence=0.95, possible=("possible",))))
    levels = {each["partialFingerprints"]["findingId/v1"]: each["level"] for each in run["results"]}
    assert levels == {"sure": "error", "possible": "note"}
    assert {each["level"] for each in log(result([verdict("fail")], found))["results"]} == {"error"}


def test_the_same_result_gives_the_same_bytes() -> None:
    assert sarif.render(HOSTILE) == sarif.render(HOSTILE)
