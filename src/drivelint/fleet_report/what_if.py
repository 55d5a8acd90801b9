"""`drivelint what-if`: shows which verdicts of an audit change with another value of a parameter."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import msgspec

from drivelint import catalogue
from drivelint.errors import ExitCode, UsageError
from drivelint.fleet.rates import check_tag_exists
from drivelint.fleet.what_if import WhatIf, flipped_verdicts, what_if
from drivelint.fleet_report.audit_views import open_audits
from drivelint.phrases import hint, one_line, plural
from drivelint.result.text import ego_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import duckdb

    from drivelint.catalogue import Rule
    from drivelint.fleet.what_if import FlipCount, FlippedVerdict
    from drivelint.fleet_report.audit_views import Audit

WHAT_IF_SCHEMA_VERSION: Final = 1
"""Version of the JSON format: raised when a key is removed or changes its meaning."""
MAX_TEXT_LINES: Final = 50
"""Largest number of tag values, and of verdicts, in the text; the JSON has all values."""
MAX_FLIPPED_VERDICTS: Final = 10_000
"""Largest number of changed verdicts in the JSON."""


@dataclass(frozen=True)
class AuditWhatIf:
    """A request of `what-if` and its result. `setting`: as `RULE.PARAM=VALUE`; `old_value`: the value in the audit; `tag`: None: no tag.

    `flipped`: the changed verdicts. `by_tag_value`: the verdicts by profile and value of the tag. If a log has several values of the tag,
    its verdicts count for each value, but only once in `answer`.
    """

    audit: Audit
    setting: str
    old_value: str
    tag: str | None
    answer: WhatIf
    flipped: tuple[FlippedVerdict, ...] = ()
    by_tag_value: tuple[FlipCount, ...] = ()

    @property
    def exit_code(self) -> ExitCode:
        """The exit code: NOT_JUDGED if a new audit is needed, the audit has not ended, or it has no verdict of the rule; else OK."""
        left = self.answer.needs_check or self.answer.not_known or self.audit.warning or not self.answer.verdicts
        return ExitCode.NOT_JUDGED if left else ExitCode.OK


def what_if_in_audit(dest: str, setting: str, tag: str | None) -> AuditWhatIf:
    """Return the effect of `setting` (`RULE.PARAM=VALUE`) on the verdicts of the audit in `dest`, divided by the values of a tag.

    Errors: `UsageError` for an audit, rule, parameter, value or tag that does not exist.
    """
    with open_audits(dest) as (con, audit, _):
        check_tag_exists(con, tag, "")
        rules = catalogue.load_rules([Path(folder) for folder in audit.settings.get("rules_dirs", ())])
        ((rule_id, values),) = catalogue.parse_params(rules.values(), [setting]).items()
        ((param, value),) = values.items()
        version, old_value = _rule_version_and_param_value(con, rule_id, param)
        rule = rules[rule_id]
        if version != rule.version:
            why = "the rule has changed since the audit: its stored verdicts cannot be used for the present rule"
            return AuditWhatIf(audit, setting, old_value, tag, WhatIf(rule_id, param, float(value), why))
        by_tag = _what_if_or_refusal(con, rule, param, value, tag)
        if by_tag.needs_check:
            return AuditWhatIf(audit, setting, old_value, tag, by_tag)
        answer = by_tag if tag is None else _what_if_or_refusal(con, rule, param, value, None)
        return AuditWhatIf(
            audit, setting, old_value, tag, answer, flipped_verdicts(con, MAX_FLIPPED_VERDICTS), by_tag.verdicts
        )


def _what_if_or_refusal(
    con: duckdb.DuckDBPyConnection, rule: Rule, param: str, value: float | str | bool, tag: str | None
) -> WhatIf:
    if isinstance(value, bool | str):
        return WhatIf(rule.id, param, 0.0, f"{param} is no number")
    return what_if(con, rule, param, float(value), tag)


def _rule_version_and_param_value(con: duckdb.DuckDBPyConnection, rule_id: str, param: str) -> tuple[str, str]:
    """Return the version of a rule in the audit, and the value of its parameter there."""
    rules = dict(
        con.execute("SELECT rule_id, {'version': rule_version, 'params': params} FROM rules ORDER BY ALL").fetchall()
    )
    if rule_id not in rules:
        raise UsageError(f"the audit has no verdicts of rule {rule_id}; {hint(rule_id, rules)}")
    values = {entry["name"]: entry["value"] for entry in rules[rule_id]["params"]}
    return rules[rule_id]["version"], values.get(param, "not set")


def to_text(analysis: AuditWhatIf) -> str:
    """Return the result as text: the changes of verdicts, by the values of the tag."""
    answer = analysis.answer
    lines = [
        f"{analysis.setting} instead of {analysis.old_value}, computed from the verdicts that are stored in {analysis.audit.dest}"
    ]
    if analysis.audit.warning:
        lines.append(analysis.audit.warning)
    if answer.needs_check:
        return "\n".join([*lines, f"needs a new audit: {answer.needs_check}", _advice_on_new_audit(analysis)])
    total, flips = sum(count.n for count in answer.verdicts), sum(count.n for count in answer.flips)
    words = ", ".join(f"{n} {was} -> {becomes}" for (was, becomes), n in _counts_by_change(answer.flips))
    lines.append(f"{flips} of {total} verdicts change{f': {words}' if words else ''}")
    if answer.not_known:
        lines.append(
            f"{plural(answer.not_known, 'verdict')} {'needs' if answer.not_known == 1 else 'need'} a new audit: the stored value may be "
            "only a bound of the observed value"
        )
    lines += _lines_by_tag_value(analysis)
    lines += _flipped_verdict_lines(analysis.flipped, flips + answer.not_known)
    lines.append(
        "Findings are not predicted: one verdict may have several findings, and the beginning and end of each depend on every step."
    )
    return "\n".join([*lines, _advice_on_new_audit(analysis)] if answer.not_known else lines)


def _counts_by_change(flips: Iterable[FlipCount]) -> list[tuple[tuple[str, str | None], int]]:
    pairs = sorted((flip.was, flip.becomes or "", flip.n) for flip in flips)
    return [(key, sum(n for *_, n in group)) for key, group in groupby(pairs, key=lambda pair: pair[:2])]


def _lines_by_tag_value(analysis: AuditWhatIf) -> list[str]:
    """Return a line per value of the tag and profile, with the changes of its verdicts."""
    flips_by_group: dict[tuple[str, str], list[FlipCount]] = {}
    for flip in sorted(
        analysis.by_tag_value,
        key=lambda f: (f.tag_value is None, f.tag_value or "", f.profile or "", f.was, f.becomes or ""),
    ):
        value = "" if analysis.tag is None else "(not given)" if flip.tag_value is None else flip.tag_value
        flips_by_group.setdefault((value, flip.profile or ""), []).append(flip)
    width = max((len(" ".join(key).strip()) for key in flips_by_group), default=0)
    lines = []
    for key, flips in list(flips_by_group.items())[:MAX_TEXT_LINES]:
        change_texts = [f"{flip.n} {_change_text(flip)}" for flip in flips]
        lines.append(one_line(f"  {' '.join(key).strip():{width}}  {', '.join(change_texts)}"))
    if len(flips_by_group) > MAX_TEXT_LINES:
        lines.append(f"  ... and {len(flips_by_group) - MAX_TEXT_LINES} more: --format json contains all")
    return lines


def _flipped_verdict_lines(verdicts: Sequence[FlippedVerdict], n: int) -> list[str]:
    """Return one line with the log for each changed verdict. `n`: the number of all changed verdicts."""
    lines = ["verdicts that change:"] if verdicts else []
    for flip in verdicts[:MAX_TEXT_LINES]:
        object_words = f" for object {flip.object_id}" if flip.object_id else ""
        profile = f" [{flip.profile}]" if flip.profile else ""
        lines.append(
            one_line(
                f"  {flip.log}: {ego_name(flip.ego_id)}{object_words}{profile}: {flip.was} -> {flip.becomes or 'needs a new audit'}"
            )
        )
    if n > MAX_TEXT_LINES:
        lines.append(f"  ... and {n - MAX_TEXT_LINES} more: --format json contains the first {MAX_FLIPPED_VERDICTS:,}")
    return lines


def _change_text(flip: FlipCount) -> str:
    if flip.becomes is None:
        return f"{flip.was} -> needs a new audit"
    return f"stay {flip.was}" if flip.becomes == flip.was else f"{flip.was} -> {flip.becomes}"


def _advice_on_new_audit(analysis: AuditWhatIf) -> str:
    return (
        f"for the complete answer: drivelint audit SOURCE --param {analysis.setting} --out OTHER, then "
        f"drivelint diff {analysis.audit.dest} OTHER"
    )


def to_json(analysis: AuditWhatIf) -> str:
    """Return the result as JSON."""
    answer = analysis.answer
    content: dict[str, Any] = {
        "what_if_schema": WHAT_IF_SCHEMA_VERSION,
        "rule_id": answer.rule_id,
        "param": answer.param,
        "value": analysis.setting.partition("=")[2],
        "was": analysis.old_value,
        "by": analysis.tag,
        "needs_audit": answer.needs_check,
        "not_known": answer.not_known,
        "warning": analysis.audit.warning,
        "verdicts": [flip._asdict() for flip in analysis.by_tag_value],
        "flipped": [verdict._asdict() for verdict in analysis.flipped],
    }
    return msgspec.json.format(msgspec.json.encode(content), indent=2).decode()
