"""What the sheet says of broken, kept and undecided rules, from a few rows each."""

from __future__ import annotations

import re
from typing import Any

import pytest

from drivelint.catalogue import load_rules
from drivelint.catalogue.header import EXCUSABLE_RULE_TAG
from drivelint.incident.breaches import ADVICE_VERBS, reason_without_advice
from drivelint.incident.conduct import conduct_texts_and_counts
from drivelint.incident.fitting import (
    UndecidedReason,
    first_fitted_texts,
    fit_conduct_lists_and_return_further_pages,
    remove_and_return_shared_reasons,
)
from drivelint.reasons.reason_text import texts_of_shared_codes

S = 1_000_000_000
SPAN = (0, 20 * S)
RULES: dict[str, dict[str, Any]] = {
    name: {"rule_id": name, "title": title, "clause": "R1: do", "hypothesis": f"Did it {name}?", "severity": "major", "kind": kind,
           "sense": sense, "unit": unit, "observes": observes, "tags": tags, "params": []}
    for name, title, kind, sense, unit, observes, tags in (
        ("boxes", "No collision", "invariant", ">", "m", "distance between the two", ["contact"]),
        ("impact", "No impact", "invariant", "<", "m/s2", "change of speed", ["contact"]),
        ("limit", "Within the limit", "invariant", "<=", "m/s", "speed", []),
        ("lane", "Within its lane", "invariant", "<=", "s", "time astride", ["excuses"]),
        ("ahead", "Safe distance ahead", "execution", ">", "m", "distance ahead", []),
        ("lamps", "Headlights at night", "invariant", "holds", None, None, []),
    )
}  # fmt: skip


def row(rule: str, verdict: str = "pass", **over: Any) -> dict[str, Any]:
    values: dict[str, Any] = {
        "t_start_ns": SPAN[0], "t_end_ns": SPAN[1], "t_worst_ns": 2 * S, "observed": 1.0, "required": 2.0, "margin": 1.0, "profile": None,
        "object_id": None, "near_miss": False, "finding_ids": [], "reason": "", "reason_code": "kept", "cause_code": None,
    }  # fmt: skip
    return {**values, "rule_id": rule, "verdict": verdict, "unit": RULES[rule]["unit"], **over}


def finding(rule: str, copies: tuple[int, int] | None, **over: Any) -> dict[str, Any]:
    n = dict(zip(("n_stays", "n_copies"), copies or (None, None), strict=True))
    return {**row(rule, "fail", margin=-1.0, finding_id="f", drive_id="d", ego_id="ego", **over), **n}


def conduct(verdicts: list[dict[str, Any]], findings: list[dict[str, Any]], *, touched: bool = False) -> dict[str, Any]:
    found = conduct_texts_and_counts(verdicts, findings, RULES, SPAN, 0, is_about_contact=touched)
    fit_conduct_lists_and_return_further_pages([found], 0, 0)
    return found


@pytest.mark.parametrize("touched", [False, True])
def test_no_rule_of_contacts_is_kept_under_a_contact(*, touched: bool) -> None:
    """Another finding of the party is a contact, or the sheet is about one."""
    hit = [] if touched else [finding("impact", (32, 32))]
    found = conduct([row("boxes", object_id="3", observed=0.14, required=0.0), row("limit")], hit, touched=touched)
    assert not any("distance between" in line or "No collision" in line for line in found["kept"].texts)
    assert found["beside"] == ["distance between the two with 3: 0.14 m (more than 0.00 m)"]
    assert found["n"]["kept"] == 1
    assert sum(found["n"].values()) + found["never"] + len(found["beside"]) == len(RULES)


def test_a_rule_with_excuses_is_not_said_to_be_kept() -> None:
    found = conduct([row("lane", observed=0.0, required=5.0)], [])
    assert found["kept"].texts == []
    assert found["excused"].texts == ["\u201cWithin its lane\u201d"]  # and not that it was astride for 0 s


def test_kept_is_named_by_what_was_measured_and_when() -> None:
    part = row("limit", observed=5.9, required=18.3, t_end_ns=7 * S)
    assert conduct([row("limit", observed=5.9, required=18.3)], [])["kept"].texts == [
        "speed 5.90 m/s (at most 18.30 m/s)"
    ]
    assert conduct([part], [])["kept"].texts == ["speed 5.90 m/s (at most 18.30 m/s; 0.00 to 7.00 s)"]
    limit = {
        **RULES["limit"],
        "params": [{"name": "tolerance_mps", "value": "0.45", "unit": "m/s", "overridden": False}],
    }
    (line,) = conduct_texts_and_counts([part], [], {**RULES, "limit": limit}, SPAN, 0)["kept"]
    assert line == "speed 5.90 m/s (at most 18.30 m/s, including 0.45 m/s tolerance; 0.00 to 7.00 s)"
    bound = {**part, "cause_code": "lower_bound"}
    assert conduct([bound], [])["kept"].texts == ["speed at least 5.90 m/s (at most 18.30 m/s; 0.00 to 7.00 s)"]
    assert conduct([{**part, "near_miss": True}], [])["kept"].texts[0].endswith("; near miss)")


def test_how_sure_several_findings_are() -> None:
    found = [
        finding("impact", copies, t_start_ns=s * S, t_end_ns=s * S)
        for s, copies in enumerate([(32, 32), (49, 100), (50, 100)])
    ]
    assert conduct([], found)["broken"].texts[0].endswith("(3 findings: 1 sure, 2 possible)")
    assert conduct([], found[:1])["broken"].texts[0].endswith("; sure, 32 of 32")
    assert conduct([], [finding("impact", None)])["broken"].texts[0].endswith("; certainty not examined")


def test_begin_and_worst_time() -> None:
    lasting = finding("impact", None, t_start_ns=9 * S, t_end_ns=11 * S, t_worst_ns=10 * S)
    assert ": from 9.00 s to 11.00 s, worst at 10.00 s, " in conduct([], [lasting])["broken"].texts[0]
    once = finding("ahead", None, t_start_ns=7 * S, t_end_ns=7 * S, t_worst_ns=7 * S)
    assert ": for the manoeuvre at 7.00 s, " in conduct([], [once])["broken"].texts[0]


def test_every_profile_is_told_the_mildest_first_and_one_overtake_counts_once() -> None:
    needs = {"relaxed": 112.57, "aggressive": 51.19, "nominal": 74.92}
    found = [finding("ahead", (32, 32), profile=name, observed=45.59, required=m) for name, m in needs.items()]
    found = [{**each, "margin": each["observed"] - each["required"]} for each in found]
    assert (
        "45.59 m, must be more than 51.19 m (planned as aggressive), 74.92 m (planned as nominal), "
        "112.57 m (planned as relaxed); sure, 32 of 32" in conduct([], found)["broken"].texts[0]
    )


def test_what_was_not_decided_is_said_in_full_without_advice() -> None:
    reason = "the log does not record when the headlights are on: record either their signal or the event headlights, on and off"
    found = conduct([row("lamps", "unknown", reason=reason, reason_code="missing", finding_ids=None)], [])
    assert found["reasons"].texts == [
        "\u201cHeadlights at night\u201d: The log does not record when the headlights are on"
    ]


REASONS = [
    UndecidedReason(f"Why number {n:02}", tuple(f"\u201cTitle {n:02}.{k} of a rule\u201d" for k in range(20 - n)))
    for n in range(20)
]


def test_every_reason_is_told_before_any_loses_no_more_than_titles() -> None:
    """Twenty reasons whose titles are too long for the page are told, the longest by the number of their rules."""
    party: dict[str, Any] = {"reasons": list(REASONS)}
    fit_conduct_lists_and_return_further_pages([party], 0, 0)
    shown, more, is_short = party["reasons"]
    assert (len(shown), more, is_short) == (20, 0, True)
    assert shown[0] == "Why number 00 (20 rules)"
    assert shown[-1] == REASONS[-1].full_text
    assert sum(map(len, shown)) < 3300 < sum(len(reason.full_text) for reason in REASONS)


def test_reasons_come_before_what_the_other_lists_would_take() -> None:
    party: dict[str, Any] = {"kept": ["a measure of a rule that was kept"] * 200, "reasons": list(REASONS)}
    fit_conduct_lists_and_return_further_pages([party], 0, 0)
    assert party["reasons"].more == 0
    assert party["kept"].more > 100


def test_reasons_that_do_not_fit_are_counted() -> None:
    party: dict[str, Any] = {"reasons": list(REASONS)}
    fit_conduct_lists_and_return_further_pages([party], 0, 3300)
    assert len(party["reasons"].texts) + party["reasons"].more == 20
    assert party["reasons"].more > 0


def test_what_is_undecided_of_both_for_the_same_reason_is_told_once() -> None:
    first: dict[str, Any] = {"reasons": REASONS[:3]}
    second: dict[str, Any] = {"reasons": [*REASONS[1:4], REASONS[0]._replace(titles=("another",))]}
    assert remove_and_return_shared_reasons([first, second]) == {"reasons": REASONS[1:3]}
    assert first["reasons"] == REASONS[:1]
    assert second["reasons"] == [REASONS[3], REASONS[0]._replace(titles=("another",))]
    assert remove_and_return_shared_reasons([{"reasons": REASONS}, {"not_judged": "a pedestrian"}]) == {"reasons": []}


def test_texts_that_do_not_fit_are_counted() -> None:
    assert first_fitted_texts(["a" * 10] * 5, 30) == (["a" * 10] * 2, 3, False)
    assert first_fitted_texts([], 30) == ([], 0, False)


def test_advice_begins_with_a_known_word() -> None:
    """Else it stays in the reason, which is only longer."""
    texts = [
        *texts_of_shared_codes().values(),
        *(text for rule in load_rules().values() for text in rule.reasons.values()),
    ]
    plain = [text.advice for text in texts if text.advice]
    assert len(plain) > 50
    assert sum(advice.split()[0] in ADVICE_VERBS for advice in plain) > 0.9 * len(plain)
    assert reason_without_advice("no map: give one with --map") == "no map"
    assert reason_without_advice("rule x: did not end") == "rule x: did not end"


def test_a_rule_that_excuses_something_says_so_by_its_tag() -> None:
    excuses = re.compile(r"outside an? |, or may |own accord|without an emergency|nobody in its way|, unless ")
    rules = load_rules().values()
    assert {rule.id for rule in rules if excuses.search(rule.hypothesis)} == {
        rule.id for rule in rules if EXCUSABLE_RULE_TAG in rule.tags
    }


def test_one_reason_in_words_is_told_once_whatever_its_codes() -> None:
    """The rules behind it advise differently, which the sheet leaves out."""
    rows = [
        row(rule, "unknown", reason_code=code, reason=f"the log ends: {advice}")
        for rule, code, advice in (("boxes", "a", "record it until it is back"), ("limit", "b", "see what it did"))
    ]
    found = conduct(rows, [])
    assert found["reasons"].texts == [
        f"\u201c{RULES['boxes']['title']}\u201d, \u201c{RULES['limit']['title']}\u201d: The log ends"
    ]


def test_why_a_contact_is_not_decided_is_told_first() -> None:
    """A page that has room for one reason must not leave that one out."""
    rows = [row(rule, "unknown", reason_code="x", reason="no lights") for rule in ("limit", "lane")]
    found = conduct([*rows, row("boxes", "unknown", reason_code="y", reason="the boxes are apart")], [])
    assert found["reasons"].texts[0].startswith(f"\u201c{RULES['boxes']['title']}\u201d")
