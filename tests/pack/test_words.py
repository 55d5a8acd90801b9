"""What `pack` and `verify` say: findings are counted as in the reports, and an altered file is named with what is wrong with it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from drivelint.pack.bag import Problem, explanation_text, sha256_of
from drivelint.pack.consistency import problems_and_content
from drivelint.pack.contents import phrase_on_findings_with_sql
from drivelint.pack.statement import (
    FILES_IN_STATEMENT,
    STATEMENT_FILE,
    altered_file_problems,
    resource_descriptor,
    statement_problems,
)

if TYPE_CHECKING:
    from pathlib import Path


def finding(finding_id: str, profile: str | None, *, start_ns: int = 0) -> dict[str, Any]:
    at = {"t_start_ns": start_ns, "t_end_ns": start_ns + 5, "n_copies": None, "n_stays": None}
    who = {"drive_id": "d", "rule_id": "r", "ego_id": "ego", "object_id": "other"}
    return {"finding_id": finding_id, "profile": profile, **who, **at}


def test_an_overtake_under_two_profiles_is_one_finding_of_a_pack() -> None:
    rows = [finding("a", "nominal"), finding("b", "observed"), finding("c", None, start_ns=100)]
    entries = [
        {"finding_id": name, "sql": None if name == "c" else f"data/findings/{name}/finding.sql"} for name in "abc"
    ]
    assert phrase_on_findings_with_sql(rows, entries) == (
        "1 of 2 findings has SQL that computes the margin (3 rows, 2 findings: an overtake under two profiles counts once)"
    )
    assert phrase_on_findings_with_sql(rows[2:], entries) == "0 of 1 finding have SQL that computes the margin"
    assert phrase_on_findings_with_sql(rows[:1], entries) == "1 of 1 finding has SQL that computes the margin"


def statement(manifest_sha256: str) -> bytes:
    sealed = [resource_descriptor(name, "0" * 64) for name in FILES_IN_STATEMENT[:-1]]
    predicate = {
        "configuration": [],
        "drivelint_pack": [*sealed, resource_descriptor(FILES_IN_STATEMENT[-1], manifest_sha256)],
    }
    return json.dumps({"_type": "t", "predicateType": "p", "subject": [], "predicate": predicate}).encode()


def test_the_file_whose_bytes_were_altered_is_named() -> None:
    (problem,) = statement_problems(statement("1" * 64), statement("2" * 64))
    assert problem == ("file changed since the statement about it", "manifest-sha256.txt")
    assert explanation_text(problem) == (
        ": its bytes are not those that the statement lists, so a file in data/ was changed, added or removed, and the manifest was "
        "written again"
    )
    assert statement_problems(statement("1" * 64), statement("1" * 64)) == []
    lost = json.loads(statement("1" * 64))
    lost["predicate"]["drivelint_pack"] = None
    assert [each.subject for each in statement_problems(json.dumps(lost).encode(), statement("1" * 64))] == list(
        FILES_IN_STATEMENT
    )


def test_the_altered_file_is_named_though_the_result_is_unreadable(tmp_path: Path) -> None:
    for name in FILES_IN_STATEMENT:
        (tmp_path / name).write_text(name)
    sealed = [resource_descriptor(name, sha256_of(tmp_path / name)) for name in FILES_IN_STATEMENT]
    said = json.dumps({"predicate": {"drivelint_pack": sealed}}).encode()
    assert altered_file_problems(said, tmp_path) == []
    (tmp_path / STATEMENT_FILE).write_bytes(said)
    (tmp_path / FILES_IN_STATEMENT[-1]).write_text("other")
    problems, stated = problems_and_content(tmp_path)
    assert stated is None
    assert problems[0] == ("file changed since the statement about it", "manifest-sha256.txt")
    assert problems[1].kind == "result not readable"
    assert altered_file_problems(b"no JSON", tmp_path) == []


def test_each_line_about_a_file_says_what_is_wrong_with_it() -> None:
    changed = explanation_text(Problem("file changed", "data/result/verdicts.parquet"))
    assert changed == ": its bytes are not those that the manifest lists"
    assert explanation_text(Problem("manifest changed", "manifest-sha256.txt")).endswith(
        "those that tagmanifest-sha256.txt lists"
    )
    assert explanation_text(Problem("not signed", "statement.dsse.json")) == ""
