"""A rule about speed with its cases, as packs of a test have it."""

from __future__ import annotations

from pathlib import Path

from drivelint.casefile import commands as workshop
from drivelint.catalogue import Rule
from drivelint.errors import ExitCode
from tests.evaluate.packs import INVARIANT, MEASURE, write

LIMIT = '[params.limit]\ndefault = 13\nunit = "m/s"\nwhy = "a test"'

SPEED = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, $limit AS required FROM ego_state"

CASES = """
- name: clean
  given: {ego_state: {t_s: 0..1 by 0.1, speed_mps: 14}}
  expect: pass
- name: boundary
  given: {ego_state: {t_s: 0..1 by 0.1, speed_mps: 13}}
  expect: [{verdict: fail, margin: 0}]
- name: violation
  given: {ego_state: {t_s: 0..1 by 0.1, speed_mps: 12}}
  expect: fail
- name: unknown
  given: {ego_state: {t_s: 0..1 by 0.1}}
  expect: unknown
"""


class Lines(list[str]):
    """What a command printed."""

    def __call__(self, line: str) -> None:
        self.append(line)


def said_of(folder: Path, *only: str) -> tuple[ExitCode, str]:
    """Return the exit code of `rules test` over a folder, and what it prints."""
    said = Lines()
    code = workshop.case_test(folder, only, said)
    return code, "\n".join(said)


def with_cases(rule: Rule, cases: str) -> Rule:
    rule.path.with_suffix(".cases.yml").write_text(cases, encoding="utf-8")
    return rule


def measured_rule(folder: Path, sql: str = SPEED, header: dict[str, str] | None = None, tables: str = LIMIT) -> Rule:
    fields = INVARIANT | MEASURE | {"reads": '["ego_state"]'} | (header or {})
    return write(folder, fields, {"condition": sql}, tables=tables)
