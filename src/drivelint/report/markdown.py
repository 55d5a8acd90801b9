"""`report.md`: GitHub-flavoured Markdown, short enough for a comment on a pull request."""

from __future__ import annotations

import re
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import quote

import pyarrow.compute as pc

from drivelint.gate import descriptions
from drivelint.phrases import escape_invisible, plural, terminal_safe_line
from drivelint.report.html.anchors import anchor
from drivelint.report.inputs import input_notes
from drivelint.report.outcome import headline, one_finding_per_event_and_status, status_at_gate
from drivelint.report.worst_first import moment_ns, when
from drivelint.result import counts
from drivelint.result.certainty import doubt_words
from drivelint.result.gate import n_findings
from drivelint.result.model import exit_status
from drivelint.result.text import utc_at
from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.gate import ComparedFinding, Difference, Gate
    from drivelint.result.model import Result

MAX_ROWS: Final = 40
"""The greatest number of rows in a table."""
MAX_CHARS: Final = 60_000
"""The greatest length of a report, below GitHub's limit of 65,536 characters for a comment."""
MAX_REASON_CHARS: Final = 160
"""The greatest number of characters of a reason."""

_PART_SEPARATOR: Final = "\f"


def render(result: Result, base_url: str | None = None) -> bytes:
    """Return the summary as UTF-8 Markdown.

    `base_url`: the address of the result folder; None: no links, because a relative link in a comment leads into the repository.

    Findings that gate come first, then findings that a baseline or a waiver lets through, then verdicts that could not be judged.
    """
    end, gate = exit_status(result), result.gate
    rules = {row["rule_id"]: row for row in result.rules.to_pylist()}
    findings = [
        (row, descriptions.why_not_gating(result, row, rules.get(row["rule_id"])))
        for row in result.findings.to_pylist()
    ]
    findings.sort(key=lambda item: counts.SEVERITIES.index(item[0]["severity"]))
    target = base_url and quote(f"{base_url.rstrip('/')}/report.html", safe="/:?&=%+,;@~.-_!$")  # encodes ( and )
    parts = _render_parts(
        "report.md.j2",
        outcome=end,
        headline=headline(result),
        inputs=input_notes(result),
        packs=counts.verdict_counts_by_pack(result.rules, result.verdicts),
        gate=gate,
        stopping=[item for item in findings if not item[1]],
        excused=[item for item in findings if item[1]],
        n_new_excused=len(
            one_finding_per_event_and_status(
                gate, [row for row, why in findings if why and status_at_gate(gate, row["finding_id"]) == "new"]
            )
        ),
        counted=lambda items: one_finding_per_event_and_status(gate, [row for row, _ in items]),
        rows_of_findings=lambda items, events: counts.extra_rows_sentence([row for row, _ in items], events),
        rules=rules,
        starts=result.start_times,
        drives={row["drive_id"]: row for row in result.drives.to_pylist()},
        target=target,
        titles={standing: title for standing, title in descriptions.DIFF_STATUS_TITLES.items() if standing != "new"},
        warnings=list(descriptions.waiver_warnings(gate)) if gate else [],
        lost=result.drives.filter(pc.equal(result.drives["status"], "not_judged")).to_pylist(),
        open=_reasons_of_unknowns_and_errors(result),
    )
    room = list(accumulate(len(part) + 2 for part in parts))
    shown_parts = [part for part, n in zip(parts, room, strict=True) if n <= MAX_CHARS]
    if len(shown_parts) < len(parts):
        shown_parts.append(f"{plural(len(parts) - len(shown_parts), 'part')} left out to keep this comment short.")
    shown_parts.append(
        f"[The complete report]({target})"
        if target
        else "The complete report is report.html in the folder of the results."
    )
    return ("\n\n".join(shown_parts) + "\n").encode("utf-8", "replace")


def render_difference(
    diff: Difference, failing: Sequence[ComparedFinding], fail_on: str, gate: Gate | None = None
) -> str:
    """Return the difference of two results as Markdown."""
    summary, titles = descriptions.exit_summary(diff, failing, fail_on), descriptions.DIFF_STATUS_TITLES
    return "\n\n".join(
        _render_parts("difference.md.j2", diff=diff, summary=summary, titles=titles, gate=gate, target=None)
    )


def _render_parts(template: str, **values: Any) -> list[str]:
    """Render a template and return its parts."""
    filters: dict[str, Any] = {
        "code": markdown_code,
        "doubt": doubt_words,
        "escaped": escape_markdown,
        "finding_line": descriptions.finding_line,
        "unknowns_by_reason": descriptions.unknowns_by_reason,
        "difference_headline": descriptions.difference_headline,
        "judged_less_sentence": descriptions.judged_less_sentence,
        "earlier_findings_sentence": descriptions.earlier_findings_sentence,
        "short": _short_reason,
        "utc_at": utc_at,
        "moment_ns": moment_ns,
        "when": when,
    }
    text = text_template(__file__, template, **filters).render(
        most=MAX_ROWS,
        end_part=_PART_SEPARATOR,
        anchor=anchor,
        n_findings=n_findings,
        surplus_rows_sentence=descriptions.more_rows_than_findings_sentence,
        **values,
    )
    return [part.strip("\n") for part in text.split(_PART_SEPARATOR)]


def escape_markdown(text: str) -> str:
    """Return a text escaped so that Markdown shows it unchanged, without markup, HTML, links or mentions.

    An invisible word joiner prevents GitHub from linking addresses, mentions and numbers of issues.
    """
    line = escape_invisible(" ".join(text.split()))
    apart = re.sub(r"(@|#)(?=\w)|:(?=//)|(?<=www)(?=\.)", "\\g<0>\u2060", line)
    escaped = re.sub(r"([\\`*_\[\]<>|~&!$])", r"\\\1", apart)
    return re.sub(r"^([-+#])", r"\\\1", escaped)


def markdown_code(text: str) -> str:
    """Return an id or a command as Markdown code, also valid in a table.

    The enclosing run of backticks is longer than each run in the text.
    """
    plain = terminal_safe_line(" ".join(text.split())).replace("|", "\\|")
    fence = "`" * (1 + max(map(len, re.findall("`+", plain)), default=0))
    space = " " if plain[:1] == "`" or plain[-1:] == "`" else ""
    return f"{fence}{space}{plain}{space}{fence}" if plain else ""


def _reasons_of_unknowns_and_errors(result: Result) -> list[dict[str, Any]]:
    """Return the reasons of unknown verdicts and errors, with their rules and numbers of verdicts, the most frequent first."""
    rows = counts.distinct_rows(counts.undecided_verdicts(result.verdicts), ["verdict", "reason", "rule_id"])
    entries = [
        {
            "verdict": verdict,
            "reason": reason,
            "rules": sorted(row["rule_id"] for row in alike),
            "n": sum(row["count_all"] for row in alike),
        }
        for (verdict, reason), alike in counts.group_rows(rows, lambda row: (row["verdict"], row["reason"])).items()
    ]
    return sorted(entries, key=lambda row: (row["verdict"], -row["n"], row["reason"]))


def _short_reason(text: str) -> str:
    return text if len(text) <= MAX_REASON_CHARS else text[: MAX_REASON_CHARS - 3] + "..."
