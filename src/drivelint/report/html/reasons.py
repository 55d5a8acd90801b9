"""Why something could not be judged, in one line per reason: first what can be provided, then what the logs did not tell."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.phrases import plural
from drivelint.report.html.anchors import rule_anchor

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

MOST: Final = 60
_NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
_ASIDE: Final = (
    (re.compile(rf" \({_NUMBER}[^()]*\)"), ""),  # measured values in brackets
    (re.compile(rf", at least {_NUMBER} m away"), ""),
    (re.compile(rf" (?:at|from|between) {_NUMBER} s(?: (?:to|and) {_NUMBER} s)?"), ""),
    (re.compile(r"\b(lanelet|object|actor|vehicle|crossing|junction|lane) [\w.:-]*\d[\w.:-]*"), r"a \1"),
    (re.compile(rf"\b{_NUMBER}\b"), "some"),
)
_LEAD: Final = re.compile(r"^(?:Not judged|Not decided|Not applicable): ")
_STOP: Final = re.compile(r"(?<!\.)\.$")
_LABEL: Final = re.compile(rf"^[a-z ]+: (?={_LEAD.pattern[1:]})")


class Reason(NamedTuple):
    """A reason and how many are like it, whether something can be provided, the rules (title and link) and how often."""

    verdict: str
    why: str
    provide: bool
    rules: list[tuple[str, str]]
    n: int
    n_drives: int


@lru_cache(4096)
def kind(reason: str) -> str:
    """Return what reasons that differ in times, numbers and ids only have in common. It is no sentence: nobody reads it."""
    text = _STOP.sub("", _LEAD.sub("", _LABEL.sub("", reason)))
    for pattern, instead in _ASIDE:
        text = pattern.sub(instead, text)
    return text


def in_words(given: Iterable[str]) -> str:
    """Return the first of these reasons as it is given, and how many more there are. What stands before it says the verdict.

    The shortest is the first, and of these the first by letter: the order of the rows does not matter.
    """
    sentences = {
        _STOP.sub("", reason): reason for reason in sorted(given)
    }  # one of a sentence with and without its full stop
    first, *others = sorted(sentences, key=lambda reason: (len(reason), reason))
    alike = sum(kind(reason) == kind(first) for reason in others)
    more = [f"{alike} more like it"] if alike else []
    more += [plural(len(others) - alike, "other reason")] if len(others) > alike else []
    shown = _LEAD.sub("", f"{first} (and {' and '.join(more)})" if more else sentences[first])
    return shown[:1].upper() + shown[1:]


def can_be_provided(code: str) -> bool:
    """Whether a log, a map or an option could tell what was missing: a signal, or a condition of the drive."""
    return (code.startswith("missing_") and code != "missing_step") or (
        code.endswith("_unknown") and code not in _OF_THE_MOMENT
    )


_OF_THE_MOMENT: Final = {"applies_unknown", "anchor_unknown", "reference_time_unknown"}


def reasons(verdicts: pa.Table, titles: Mapping[str, str]) -> list[Reason]:
    """Return why verdicts are unknown or errors; what can be provided first, then the most frequent."""
    rows = verdicts.filter(pc.is_in(verdicts["verdict"], value_set=pa.array(["unknown", "error"])))
    keys = ["verdict", "reason_code", "reason", "rule_id", "drive_id"]
    counted = rows.group_by(keys, use_threads=False).aggregate([([], "count_all")]).to_pylist()
    grouped: dict[tuple[str, bool, str], list[dict[str, Any]]] = {}
    for row in counted:
        key = row["verdict"], can_be_provided(row["reason_code"]), kind(row["reason"])
        grouped.setdefault(key, []).append(row)
    found = [
        Reason(
            verdict,
            in_words(row["reason"] for row in told),
            provide,
            named({row["rule_id"] for row in told}, titles),
            sum(row["count_all"] for row in told),
            len({row["drive_id"] for row in told}),
        )
        for (verdict, provide, _), told in grouped.items()
    ]
    return sorted(found, key=lambda r: (r.verdict, not r.provide, -r.n, r.why))[:MOST]


def named(rules: Iterable[str], titles: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return titles of rules with links to them."""
    return [(titles.get(rule, rule), "#" + rule_anchor(rule)) for rule in sorted(rules)]
