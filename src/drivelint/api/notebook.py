"""The HTML view of a result in a notebook: outcome, map and logs, counts, refused logs and the worst findings."""

from __future__ import annotations

from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Final

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from drivelint.api.keywords import replace_options_by_keywords
from drivelint.report.html.environment import escape_for_page
from drivelint.report.inputs import input_notes
from drivelint.report.terminal_summary import gating_findings_worst_first, outcome_line
from drivelint.report.worst_first import when
from drivelint.result import counts
from drivelint.result.certainty import certainty
from drivelint.result.model import exit_status
from drivelint.result.text import ego_and_object_names, measure, measured_values_text, rule_name

if TYPE_CHECKING:
    from jinja2 import Template

    from drivelint.result.model import Result

MOST_LISTED_FINDINGS: Final = 10
MOST_LISTED_UNJUDGED_DRIVES: Final = 10


def one_line_summary(result: Result) -> str:
    """Return on one line: the outcome, whether the map fits, whether the logs are complete, and what was not judged."""
    return f"{replace_options_by_keywords(outcome_line(result))}; {_input_notes_text(result)}"


def _input_notes_text(result: Result) -> str:
    return replace_options_by_keywords(" | ".join(f"{note.label}: {note.words}" for note in input_notes(result)))


def preformatted_html(text: str) -> str:
    """Return text as HTML whose columns stay aligned, independently of the style of the page around it."""
    return f'<pre><span style="display: inline-block; font-family: monospace; line-height: 1.2">{escape(text)}</span></pre>'


def summary_html(result: Result) -> str:
    """Return the summary of a result as HTML, with all text from logs escaped."""
    findings = gating_findings_worst_first(result)
    rules = {rule["rule_id"]: rule for rule in result.rules.to_pylist()}
    starts = result.start_times
    end = exit_status(result)
    rows = [
        {
            "drive": row["drive_id"],
            "time": when(row, rules, starts[row["drive_id"]]),
            "severity": row["severity"],
            "certainty": certainty(row),
            "rule": rule_name(row),
            "title": rules[row["rule_id"]]["title"],
            "who": ego_and_object_names(row),
            "measured": measured_values_text(row),
            "closing": "" if row["closing_mps"] is None else measure(row["closing_mps"], "m/s"),
        }
        for row in findings[:MOST_LISTED_FINDINGS]
    ]
    return _template().render(
        verdict=replace_options_by_keywords(outcome_line(result)),
        exit_code=int(end.code),
        why=replace_options_by_keywords(end.why),
        inputs=_input_notes_text(result),
        refused=[drive for drive in result.drives.to_pylist() if drive["status"] != "judged"][
            :MOST_LISTED_UNJUDGED_DRIVES
        ],
        verdicts={word.replace("_", " "): n for word, n in counts.verdict_counts(result.verdicts).items() if n},
        rows=rows,
        has_certainty=any(row["certainty"] for row in rows),
        left_out=len(findings) - len(rows),
    )


@cache
def _template() -> Template:
    environment = Environment(
        finalize=escape_for_page,
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("notebook.html.j2")
