"""All errors of a rule file, or of a file of cases, are told at once: each with its true line and the nearest name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.casefile import binding_errors
from drivelint.casefile import commands as workshop
from drivelint.errors import ExitCode
from tests.casefile.speed_rule import measured_rule, said_of, with_cases

if TYPE_CHECKING:
    from pathlib import Path


def changed_rule(folder: Path, kind: str, changes: dict[str, str]) -> dict[int, list[str]]:
    """Return the messages of `rules test`, by line, about a new rule with these changes; `line | old` names the line to change."""
    file, _ = workshop.write_new_rule("mine.rule", folder, kind)
    lines = file.read_text(encoding="utf-8").split("\n")
    for place, new in changes.items():
        number, _, old = place.partition(" | ")
        assert lines[int(number) - 1].count(old) == 1, lines[int(number) - 1]
        lines[int(number) - 1] = lines[int(number) - 1].replace(old, new)
    file.write_text("\n".join(lines), encoding="utf-8")
    code, said = said_of(file)
    assert code is ExitCode.USAGE
    found: dict[int, list[str]] = {}
    for line in said.removeprefix("REFUSED ").split("\n"):
        number, _, message = line.removeprefix(f"{file}:").partition(": ")
        found.setdefault(int(number), []).append(message)
    assert list(found) == sorted(found)
    return found


def test_all_errors_of_header_and_sql_are_told_with_their_lines(tmp_path: Path) -> None:
    said = changed_rule(
        tmp_path,
        "precondition",
        {
            "9 | severity": "severty",
            '12 | "<="': '"=<"',
            "14 | near_margin": "near_margn",
            "27 | unit": "unti",
            "33 | begin_seen": "begin_sen",
            "35 | back": "zzz",
            "39 | $most_mps": "$mst_mps",
            "40 | e.speed_mps END": "e.sped_mps + r.zzz END",
            "43 | s.t_ns": "s.tns",
        },
    )
    assert said == {
        9: ["unknown key 'severty' in the header; did you mean 'severity'?"],
        12: ["sense = '=<': did you mean '<='?"],
        14: ["unknown key 'near_margn' in the header; did you mean 'near_margin'?"],
        27: ["unknown key 'unti' in the header; did you mean 'unit'?"],
        33: ["there is no column 'begin_sen' here; did you mean 'begin_seen'?"],
        35: ["there is no column 'zzz' here; the nearest: back"],
        39: [
            (
                "$mst_mps is not a parameter of this rule; did you mean $most_mps? "
                "If not, add [params.mst_mps] to the header, with default, unit, why and source"
            )
        ],
        40: ["there is no column 'sped_mps' in e; did you mean 'speed_mps'?"],
        43: ["there is no column 'tns' in s; did you mean 't_ns'?"],
    }


@pytest.mark.parametrize(
    ("changes", "lines"),
    [
        ({'5 | "direct"': "direct", '10 | "m/s"': 'm/s"', "29 | speed_mps": "sped_mps"}, [5, 10, 29]),
        ({"14 | []": '["map"', "29 | speed_mps": "sped_mps"}, [14, 29]),
        ({"17 | 20.0": "[20.0]", '18 | "m/s"': "7", "25 | ego_state": "ego_stat"}, [17, 18, 25]),
        ({"13 | ego_state": "ego_stat", "24 | speed_mps": "sped_mps"}, [13, 24]),
        ({"27 | condition": "conditon", "29 | AS observed": "AS observd"}, [27, 29]),
        ({"24 | standing_mps": "standing", "25 | ego_state": "ego_state, zzz", "29 | speed": "sped"}, [24, 25, 29]),
        ({"24 | speed_mps >": "source = 'a' AND sped_mps >", "29 | speed_mps": "abss(sped_mps)"}, [24, 29]),
        ({"28 | NULL": "$more NULL", "29 | $most_mps": "$more + $less"}, [16, 29]),
    ],
)
def test_an_error_hides_no_other(tmp_path: Path, changes: dict[str, str], lines: list[int]) -> None:
    assert list(changed_rule(tmp_path, "invariant", changes)) == lines


@pytest.mark.parametrize("second", ["DROP TABLE ego_state", "CREATE TABLE t AS SELECT 1", "SELECT 1"])
def test_nothing_of_a_refused_section_is_executed(tmp_path: Path, second: str) -> None:
    for name, begin in (("first", f"{second}; SELECT"), ("last", "SELECT")):
        end = f"; {second}" if name == "last" else ""
        changes = {"29 | SELECT": begin, "30 | FROM ego_state": f"FROM ego_state{end}", "24 | speed_mps": "sped_mps"}
        said = changed_rule(tmp_path / name, "invariant", changes)
        assert list(said) == [24, 29 if name == "first" else 30]
    assert binding_errors._binding_database().execute("SELECT count(*) FROM ego_state").fetchall() == [(0,)]


def test_all_errors_of_cases_are_told(tmp_path: Path) -> None:
    rule = with_cases(
        measured_rule(tmp_path),
        """- name: clean
  given: {ego_state: {t_s: 0..1 by 0.1, sped_mps: 1, indicator: hazards}, pari: {t_s: 0}}
  expect: [{verdict: pass, marign: 1}]
- name: violation
  given: {ego_state: {t_s: 0}}
  expct: fail
- name: unknown
  params: {limitt: 1, foo: 2}
  given: {ego_state: {t_s: 0, speed_mps: fast}}
  expect: unknwn
""",
    )
    code, said = said_of(tmp_path)
    assert code is ExitCode.USAGE
    places = f"{rule.path.with_suffix('.cases.yml')}:"
    found = [line.removeprefix("REFUSED ").removeprefix(places) for line in said.split("\n")]
    for line, word in zip(
        found,
        ["marign", "sped_mps", "hazards", "pari", "expct", "foo", "limitt", "unknwn", "fast"],
        strict=True,
    ):
        assert word in line
    assert [line.partition(":")[0] for line in found] == ["1"] * 4 + ["4"] + ["7"] * 4
