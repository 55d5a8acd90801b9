"""The in-toto statement of a pack: the logs, the rules, the result, and the pack itself.

https://in-toto.io/attestation/test-result/v0.1. A test is one rule for one ego of a drive, and for one profile if the rule has profiles. A
test with an unknown verdict has not passed: it is listed in a field of drivelint, and the result is then at most WARNED.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, Any, Final

from drivelint.errors import ExitCode
from drivelint.pack import bag
from drivelint.pack.inputs import judged_drives

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from drivelint.result.model import Result

STATEMENT_FILE: Final = "statement.json"
ENVELOPE_FILE: Final = "statement.dsse.json"
STATEMENT_TYPE: Final = "https://in-toto.io/Statement/v1"
PREDICATE_TYPE: Final = "https://in-toto.io/attestation/test-result/v0.1"
FILES_IN_STATEMENT: Final = (bag.DECLARATION, bag.INFO, bag.MANIFEST)
"""The tag files whose hashes a statement contains. The hash of the manifest covers every file of the payload."""


def in_toto_statement(folder: Path, result: Result, summary: Mapping[str, Any], evidence: Mapping[str, Any]) -> bytes:
    """Return the statement about the result whose tables and manifest are in the pack `folder`."""
    drives = judged_drives(result.drives.to_pylist())
    tests = _tests_by_outcome(result.verdicts.to_pylist())
    maps = sorted({(drive["map_name"], drive["map_sha256"]) for drive in drives if drive["map_sha256"]})
    content = {
        "_type": STATEMENT_TYPE,
        "subject": [resource_descriptor(drive["file_name"], drive["sha256"]) for drive in drives],
        "predicateType": PREDICATE_TYPE,
        "predicate": {
            "result": result_word(tests, is_clean=summary["exit"]["code"] == ExitCode.OK),
            "configuration": [
                *(resource_descriptor(f"map {name}", digest) for name, digest in maps),
                *(resource_descriptor(f"rule {rule['rule_id']}", rule["sha256"]) for rule in evidence["rules"]),
                {
                    "name": "check",
                    "annotations": {
                        "tool": evidence["tool"],
                        **evidence["options"],
                        "parameters": evidence["parameters"],
                    },
                },
            ],
            "passedTests": tests["pass"],
            "warnedTests": tests["near_miss"],
            "failedTests": tests["fail"],
            "drivelint_undecidedTests": tests["unknown"],
            "drivelint_exit": summary["exit"],
            "drivelint_pack": [resource_descriptor(name, bag.sha256_of(folder / name)) for name in FILES_IN_STATEMENT],
        },
    }
    return (json.dumps(content, indent=2, ensure_ascii=False) + "\n").encode()


def statement_problems(statement: bytes, due: bytes) -> list[bag.Problem]:
    """Return the differences between a statement and `due`, the statement that follows from the pack's content."""
    try:
        a, b = json.loads(statement), json.loads(due)
        parts = ((a, b, ("_type", "predicateType")), (a["predicate"], b["predicate"], ()))
        keys_with_problem = [key for left, right, keys in parts for key in keys or right if left.get(key) != right[key]]
        logs = a["subject"] != b["subject"]
    except (ValueError, KeyError, TypeError, AttributeError):
        return [bag.Problem("statement not readable", ENVELOPE_FILE)]
    problems = [bag.Problem("statement about another log", "subject")] if logs else []
    for key in keys_with_problem:
        if key == "drivelint_pack":
            problems += [
                bag.Problem(bag.CHANGED_SINCE_STATEMENT, name)
                for name in _files_with_other_hash(a["predicate"].get(key), b["predicate"][key])
            ]
            continue
        kinds = {"configuration": "statement about another map, rule or parameter"}
        problems.append(bag.Problem(kinds.get(key, "statement says another result"), key))
    if not problems and statement != due:
        problems.append(bag.Problem("statement says another result", "fields in excess"))
    return problems


def altered_file_problems(statement: bytes, folder: Path) -> list[bag.Problem]:
    """Return the problems of the tag files (`FILES_IN_STATEMENT`) whose hashes are not those in the statement.

    A missing tag file is no problem here. The result in the pack may be unreadable.
    """
    try:
        listed = json.loads(statement)["predicate"]["drivelint_pack"]
    except (ValueError, KeyError, TypeError):
        return []
    there = [
        resource_descriptor(name, bag.sha256_of(folder / name))
        for name in FILES_IN_STATEMENT
        if (folder / name).is_file()
    ]
    return [bag.Problem(bag.CHANGED_SINCE_STATEMENT, file["name"]) for file in there if file not in listed]


def _files_with_other_hash(listed: Any, due: list[dict[str, Any]]) -> list[str]:
    """Return the names of the files in `due` that the statement does not list with this hash; all if it lists more, or no files."""
    wrong = [file["name"] for file in due if not isinstance(listed, list) or file not in listed]
    return wrong or [file["name"] for file in due]


def resource_descriptor(name: str, digest: str) -> dict[str, Any]:
    """Return a file or a log as an in-toto resource descriptor."""
    return {"name": name, "digest": {"sha256": digest}}


def _tests_by_outcome(verdicts: Iterable[Mapping[str, Any]]) -> dict[str, list[str]]:
    """Return outcome (pass, near_miss, fail, unknown) -> tests. The worst verdict of a test counts; a rule that did not apply is not a
    test."""
    order = ("fail", "unknown", "near_miss", "pass")
    worst: dict[str, int] = defaultdict(lambda: len(order))
    for row in verdicts:
        verdict = "unknown" if row["verdict"] == "error" else "near_miss" if row["near_miss"] else row["verdict"]
        if verdict in order:
            parts = (row["rule_id"], row["drive_id"], row["ego_id"], row["profile"])
            name = " ".join(part for part in parts if part)
            worst[name] = min(worst[name], order.index(verdict))
    return {word: sorted(name for name, no in worst.items() if order[no] == word) for word in order}


def result_word(tests: Mapping[str, list[str]], *, is_clean: bool) -> str:
    """Return PASSED, WARNED or FAILED.

    `is_clean`: the exit code is 0, so every drive was judged from a complete log and on a map that fits.
    """
    if tests["fail"]:
        return "FAILED"
    passed = is_clean and tests["pass"] and not (tests["near_miss"] or tests["unknown"])
    return "PASSED" if passed else "WARNED"
