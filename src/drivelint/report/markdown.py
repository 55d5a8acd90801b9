"""`report.md`: GitHub-flavoured Markdown, short enough for a comment on a pull request."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final
from urllib.parse import quote

import pyarrow.compute as pc

from drivelint.gate import descriptions
from drivelint.phrases import plural
from drivelint.report.html.anchors import anchor
from drivelint.result import counts
from drivelint.result.model import exit_status
from drivelint.result.text import number, rule_name, seconds, subject, with_count

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from drivelint.result.gate import ComparedFinding, Difference, Gate
    from drivelint.result.model import Result
    from drivelint.result.text import Row

MAX_ROWS: Final = 40
"""Rows per table."""
MAX_CHARS: Final = 60_000
"""A comment on GitHub has at most 65,536 characters."""
MAX_REASON_CHARS: Final = 160
"""Characters of one reason."""

_HEAD: Final = ("pass", "fail", "unknown", "not applicable", "error")


def render(result: Result, link: str = "report.html") -> bytes:
    """Return the summary as UTF-8 Markdown; `link`: where report.html is to be found.

    What gates comes first, then what a baseline or a waiver lets through, then what could not be judged.
    """
    end = exit_status(result)
    blocks = [f"## drivelint: {_mark(int(end.code))}, exit {int(end.code)}", f"{escaped(end.why)}."]
    packs = counts.verdicts_by_pack(result.rules, result.verdicts)
    blocks.append(
        _table(["pack", *_HEAD], [[code(pack), *map(str, told.values())] for pack, told in packs.items()], _HEAD)
    )
    gate = result.gate
    if gate is not None and gate.baseline is not None:
        blocks.append(f"Against the baseline: {escaped(descriptions.headline(gate.baseline))}.")
    blocks += _findings(result, link)
    if gate is not None:
        blocks += _changes(gate, link)
    blocks += _open(result)
    kept = _within(blocks)
    if len(kept) < len(blocks):
        kept.append(f"{plural(len(blocks) - len(kept), 'part')} left out here for length, not for weight.")
    return ("\n\n".join([*kept, f"[The whole report]({_target(link)})"]) + "\n").encode("utf-8", "replace")


def _within(blocks: Sequence[str]) -> list[str]:
    """Return the first blocks that a comment has room for."""
    kept, n = [], 0
    for block in blocks:
        n += len(block) + 2
        if n > MAX_CHARS:
            break
        kept.append(block)
    return kept


def difference(diff: Difference, failing: Sequence[ComparedFinding], fail_on: str, gate: Gate | None = None) -> str:
    """Return two results' difference as Markdown."""
    blocks = [
        f"## drivelint diff: {escaped(descriptions.headline(diff))}",
        f"{escaped(descriptions.exit_summary(failing, fail_on))}.",
    ]
    rows = [(diff.base_name, diff.base_verdicts), (diff.name, diff.verdicts)]
    blocks.append(_table(["result", *_HEAD], [[code(name), *map(str, told.values())] for name, told in rows], _HEAD))
    blocks += _entries(diff, descriptions.DIFF_STATUS_TITLES, gate, None)
    blocks += _opened(diff)
    for title, names in (("Only in the newer result", diff.new_only), ("Only in the base", diff.base_only)):
        if names:
            few = ", ".join(code(name) for name in names[:MAX_ROWS]) + (", ..." if len(names) > MAX_ROWS else "")
            blocks.append(f"{title}: {plural(len(names), 'drive')}: {few}")
    return "\n\n".join(blocks)


def escaped(words_: str) -> str:
    """Return words so that Markdown shows them as they are: no markup, no HTML, no link, nobody mentioned.

    A word joiner, which no reader sees, keeps GitHub from seeing addresses, mentions and numbers of issues.
    """
    one_line = " ".join(words_.split())
    apart = re.sub(r"(@|#)(?=\w)|:(?=//)|(?<=www)(?=\.)", "\\g<0>\u2060", one_line)
    escaped = re.sub(r"([\\`*_\[\]<>|~&!])", r"\\\1", apart)
    return re.sub(r"^([-+#])", r"\\\1", escaped)


def code(words_: str) -> str:
    """Return an id as code, in a table too; a backtick in it becomes an apostrophe."""
    plain = " ".join(words_.split()).replace("`", "'").replace("|", "\\|")
    return f"`{plain}`" if plain else ""


def _mark(exit_code: int) -> str:
    return {0: "passed", 1: "failed", 2: "a rule could not be run"}.get(exit_code, "not everything could be judged")


def _findings(result: Result, link: str) -> Iterator[str]:
    """Yield a table of findings that gate, then one of those that do not, with the reason."""
    starts = result.start_times
    rules = {row["rule_id"]: row for row in result.rules.to_pylist()}
    excused = [(row, _excuse(row, rules.get(row["rule_id"]), result)) for row in result.findings.to_pylist()]
    excused.sort(key=lambda item: counts.SEVERITIES.index(item[0]["severity"]))
    gate = result.gate
    kind = "New findings" if gate is not None and gate.baseline is not None else "Findings"
    for title, why in ((kind, False), ("Findings that do not gate", True)):
        rows = [item for item in excused if bool(item[1]) is why]
        if rows:
            head = ["severity", "drive", "time", "rule", "who", "observed", "required", *(["why not"] if why else [])]
            lines = []
            for row, reason_not_gating in rows[:MAX_ROWS]:
                sense = rules[row["rule_id"]]["sense"] if row["rule_id"] in rules else ""
                cells = _finding(row, sense, starts[row["drive_id"]], link)
                lines.append([*cells, escaped(_short(reason_not_gating))] if why else cells)
            heading, table = title + _shown(len(rows)), _table(head, lines)
            yield _folded(heading, table) if why else f"### {heading}\n\n{table}"


def _finding(row: Row, sense: str, start_ns: int | None, link: str) -> list[str]:
    rule = f"[{code(rule_name(row))}]({_target(link)}#{anchor('finding', row['finding_id'])})"
    measured = [escaped(number(row["observed"], row["unit"])), escaped(number(row["required"], row["unit"]))]
    if sense in {">", ">=", "<", "<="} and row["required"] is not None:
        measured[1] = f"{escaped(sense)} {measured[1]}"
    when, who = escaped(seconds(row["t_worst_ns"], start_ns)), escaped(subject(row))
    return [row["severity"], code(row["drive_id"]), when, rule, who, *measured]


def _excuse(row: Row, rule: Row | None, result: Result) -> str:
    """Return why a finding does not gate; '' where it does."""
    if reason_not_gating := descriptions.reason_not_gating(result.gate, row["finding_id"]):
        return reason_not_gating
    if rule is None or rule["status"] != "stable":
        return "draft" if rule is None else rule["status"]
    severe = () if result.fail_on == "never" else counts.SEVERITIES[: counts.SEVERITIES.index(result.fail_on) + 1]
    return "" if row["severity"] in severe else f"below --fail-on {result.fail_on}"


def _changes(gate: Gate, link: str) -> Iterator[str]:
    """Yield what a baseline and the waivers tell beyond the findings: new ones stand above."""
    if gate.baseline is not None:
        titles = {standing: title for standing, title in descriptions.DIFF_STATUS_TITLES.items() if standing != "new"}
        yield from _entries(gate.baseline, titles, gate, link)
        yield from _opened(gate.baseline)
    if said := [f"* {escaped(line)}" for line in descriptions.waiver_warnings(gate)]:
        yield "### Waivers to look at\n\n" + "\n".join(said)


def _entries(diff: Difference, titles: dict[str, str], gate: Gate | None, link: str | None) -> Iterator[str]:
    for standing, title in titles.items():
        entries = diff.with_diff_status(standing)
        if not entries:
            continue
        lines = []
        for entry in entries[:MAX_ROWS]:
            waived = " (waived)" if gate is not None and entry.finding_id in gate.waived else ""
            here = link is not None and standing == "changed"
            there = f" [see]({_target(link or '')}#{anchor('finding', entry.finding_id)})" if here else ""
            lines.append(f"* {escaped(_short(descriptions.finding_line(entry)))}{waived}{there}")
        heading, body = title + _shown(len(entries)), "\n".join(lines)
        yield f"### {heading}\n\n{body}" if standing in {"new", "unknown", "lost"} else _folded(heading, body)


def _opened(diff: Difference) -> Iterator[str]:
    groups = descriptions.group_by_reason(diff.opened)
    if groups:
        total = sum(n for _, _, n in groups)
        rows = [[str(n), _few(rules), escaped(_short(reason))] for reason, rules, n in groups[:MAX_ROWS]]
        yield f"### More is unknown than was ({total})\n\n" + _table(["verdicts", "rules", "why"], rows, ["verdicts"])


def _open(result: Result) -> Iterator[str]:
    """Yield what could not be judged and why: drives, then verdicts by reason."""
    lost = result.drives.filter(pc.equal(result.drives["status"], "not_judged")).to_pylist()
    if lost:
        lines = [
            f"* {code(row['drive_id'])}: {escaped(_short(row['status_reason'] or 'no reason given'))}" for row in lost
        ]
        rest = [f"* ... and {len(lost) - MAX_ROWS} more"] if len(lost) > MAX_ROWS else []
        yield f"### Drives that could not be judged ({len(lost)})\n\n" + "\n".join([*lines[:MAX_ROWS], *rest])
    rows = counts.distinct_rows(counts.undecided(result.verdicts), ["verdict", "reason", "rule_id"])
    if not rows:
        return
    why = counts.grouped(rows, lambda row: (row["verdict"], row["reason"]))
    told = {at: sum(row["count_all"] for row in alike) for at, alike in why.items()}
    cells = []
    for at in sorted(told, key=lambda at: (at[0], -told[at], at[1]))[:MAX_ROWS]:
        rules = sorted(row["rule_id"] for row in why[at])
        cells.append([at[0], _few(rules), escaped(with_count(_short(at[1]), told[at]))])
    more = f" (the first {MAX_ROWS} of {len(told)} reasons)" if len(told) > MAX_ROWS else ""
    n = plural(sum(told.values()), "verdict")
    table = _table(["verdict", "rules", "why"], cells)
    yield _folded(f"Could not be judged: {n}, for {plural(len(told), 'reason')}{more}", table)


def _few(rules: Sequence[str]) -> str:
    few = ", ".join(code(rule) for rule in rules[:3])
    return few + (f" and {len(rules) - 3} more" if len(rules) > 3 else "")


def _folded(title: str, body: str) -> str:
    """Return a block that GitHub shows folded; the title is our own words."""
    return f"<details><summary>{title}</summary>\n\n{body}\n\n</details>"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Collection[str] = ()) -> str:
    """Return a table; `numbers`: the columns that have them."""
    line = ["---:" if name in numbers else "---" for name in head]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (head, line, *rows))


def _shown(n: int) -> str:
    return f" (the first {MAX_ROWS} of {n})" if n > MAX_ROWS else f" ({n})"


def _short(words_: str) -> str:
    return words_ if len(words_) <= MAX_REASON_CHARS else words_[: MAX_REASON_CHARS - 3] + "..."


def _target(link: str) -> str:
    """Return a link that cannot end early."""
    return quote(link, safe="/:?&=%+,;@~.-_!$")
