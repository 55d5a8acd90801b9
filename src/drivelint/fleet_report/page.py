"""Writes `fleet.html` and `fleet.md`: one page about an audit of any size. The HTML works offline, in the style of `report.html`."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from drivelint.audit.bucket import is_url
from drivelint.fleet.coverage import STANDINGS
from drivelint.fleet_report import drive_pages, figures, moment_pages, page_files
from drivelint.fleet_report.audit_views import open_audits
from drivelint.fleet_report.content import FleetContent, fleet_content
from drivelint.fleet_report.difference_text import both_rate_texts, changes_sentence, rate_line, rate_name, ratio_text
from drivelint.fleet_report.drive_pages import DEFAULT_N_DRIVE_PAGES
from drivelint.gate.descriptions import DIFF_STATUS_TITLES, finding_line
from drivelint.phrases import plural
from drivelint.reasons.signals import DEFAULT_REMEDY, how_to_provide, remedy
from drivelint.report.html.environment import page_environment
from drivelint.report.markdown import escape_markdown, markdown_code
from drivelint.report.progress import Silent
from drivelint.result.counts import SEVERITIES, VERDICTS
from drivelint.result.text import breach_title
from drivelint.result.text_templates import text_template

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import duckdb
    from jinja2 import Environment

    from drivelint.fleet.missing_signals import MissingSignal, UndecidedReason
    from drivelint.fleet.rates import Rate
    from drivelint.fleet_report.audit_views import Audit
    from drivelint.report.progress import Progress

FORMATS: Final = ("html", "markdown")
NO_LINKS: Final[Mapping[str, str]] = MappingProxyType({})
_FILE_NAMES: Final = {"html": "fleet.html", "markdown": "fleet.md"}
_STANDING_TITLES: Final = {
    "never_decided": "Never decided: no verdict passed or failed, some are unknown",
    "never_triggered": "Never triggered: the situations of these rules did not occur",
    "never_in_force": "Never in force: the drives were in another nation, in other conditions, or without an automated driver",
    "not_run": "Not run: no drive was judged by these rules",
}
_HERE: Final = Path(__file__).parent


def write_fleet_page(
    dest: str,
    report_format: str,
    tags: Sequence[str],
    baseline: str | None,
    *,
    most_drives: int | None = DEFAULT_N_DRIVE_PAGES,
    most_moments: int | None = None,
    progress: Progress | None = None,
) -> tuple[str, Audit]:
    """Write the fleet page into an audit, and with HTML also pages of its worst drives. Return the fleet page's name, and the audit.

    `tags`: tags by which rates are divided. `most_drives`: number of drives that get their own page; None: all drives. `most_moments`:
    number of these drives whose moments are drawn; None: the default of `moment_pages`. Errors: `UsageError` for an audit or tag that does
    not exist; `OutputError`.
    """
    with open_audits(dest, baseline) as (con, audit, base):
        fleet = fleet_content(con, audit, base, tags)
        if report_format == "html":
            _write_html(con, fleet, most_drives, most_moments, progress or Silent())
        else:
            audit.results.write(_FILE_NAMES[report_format], markdown(fleet))
    return _FILE_NAMES[report_format], audit


def _write_html(
    con: duckdb.DuckDBPyConnection,
    fleet: FleetContent,
    most_drives: int | None,
    most_moments: int | None,
    progress: Progress,
) -> None:
    """Write the moments and pages of drives, then the fleet page that links to them."""
    results = fleet.audit.results
    names = drive_pages.choose_drives_and_return_page_names(con, most_drives)
    drives = moment_pages.worst_drives(con, most_moments)
    with page_files.list_pages_and_remove_earlier_ones(
        results, [*names, *(moment_pages.moments_page_name(drive["key"]) for drive in drives)]
    ) as page_names:
        links: dict[str, drive_pages.MomentsLink] = {}
        for moments in moment_pages.pages_with_moments(drives, fleet.audit, progress):
            if moments.content:
                results.write(moments.name, moments.content)
            else:
                page_names.discard(moments.name)
            links[moments.key] = drive_pages.MomentsLink(moments.name if moments.content else None, moments.reason)
        for name, page in drive_pages.pages(con, fleet.audit, fleet.rules, links):
            results.write(name, page)
        results.write(_FILE_NAMES["html"], html(fleet, drive_pages.page_urls(con, fleet.drive_keys)))


def html(fleet: FleetContent, links: Mapping[str, str] = NO_LINKS) -> bytes:
    """Return the page as HTML in UTF-8. The same audit gives the same bytes. `links`: key of a drive -> relative URL of its page."""
    text = _template_environment().get_template("fleet.html.j2").render(_template_values(fleet), links=links)
    return text.encode("utf-8", "replace")


def markdown(fleet: FleetContent) -> bytes:
    """Return the page as Markdown in UTF-8, without pictures."""
    text = text_template(
        __file__, "templates/fleet.md.j2", **_FILTERS, escaped=escape_markdown, code=markdown_code
    ).render(_template_values(fleet))
    return text.encode("utf-8", "replace")


def _template_values(fleet: FleetContent) -> dict[str, Any]:
    """Return the values for the templates."""
    assert set(_STANDING_TITLES) == set(STANDINGS) - {"decided"}  # noqa: S101 - a standing without a title would be left out
    return {
        "fleet": fleet,
        "severities": SEVERITIES,
        "stored": any(is_url(row["log"]) for row in fleet.worst),
        "verdicts": VERDICTS,
        "standings": [(title, fleet.coverage.rules_with_standing(name)) for name, title in _STANDING_TITLES.items()],
        "diff_titles": DIFF_STATUS_TITLES,
        "titles": {rule_id: rule["title"] for rule_id, rule in fleet.rules.items()},
        "breach_titles": {rule_id: breach_title(rule) for rule_id, rule in fleet.rules.items()},
    }


def _note_beside_rate(rate: Rate) -> str:
    """Return the note beside a rate on findings of egos that were not completely judged; '' if there are none."""
    if not rate.findings_of_unknown:
        return ""
    least = rate.at_least_per_100km
    return f", at least {figures.number_text(least)} over all km" if least else ", no lower bound over all km"


def _advice_on_signal(missing_signal: MissingSignal) -> str:
    """Return advice how to provide a signal in the formats of the logs that lack it."""
    formats_by_text: dict[str, list[str]] = {}
    for log_format in missing_signal.formats:
        formats_by_text.setdefault(how_to_provide(missing_signal.signal, log_format), []).append(log_format)
    return "; ".join(
        f"{', '.join(of)}: {text}" if len(formats_by_text) > 1 else text for text, of in formats_by_text.items()
    )


def _remedy_with_example(undecided: UndecidedReason) -> str:
    """Return the remedy for a reason of unknown verdicts, with the text of one verdict as an example."""
    advice = remedy(undecided.reason_code, None, "mapped")
    example = f"{undecided.rule_id}: {undecided.reason}"
    return example if advice == DEFAULT_REMEDY else f"{advice} ({example})"


_FILTERS: Final[dict[str, Any]] = {
    "figure": figures.number_text,
    "least_rate": figures.lower_bound_instead_of_zero,
    "interval": figures.rate_with_interval,
    "share": figures.percent_with_interval,
    "finding_line": finding_line,
    "rate_name": rate_name,
    "rate_sides": both_rate_texts,
    "rate_line": rate_line,
    "since": changes_sentence,
    "times": ratio_text,
    "beside": _note_beside_rate,
    "provide": _advice_on_signal,
    "mend": _remedy_with_example,
    "plural": plural,
}


@cache
def _template_environment() -> Environment:
    environment = page_environment(("tables.js", "report.js"), _HERE / "templates", ("fleet.css",))
    environment.filters |= _FILTERS
    return environment
