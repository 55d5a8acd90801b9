"""Selecting rules and setting parameters, as on the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.catalogue import Rule, parse_params, required_rules, select_rules
from drivelint.errors import UsageError
from tests.evaluate.packs import INVARIANT, MEASURE, write

if TYPE_CHECKING:
    from pathlib import Path

SQL = (
    "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, $limit AS required FROM ego_state WHERE $on AND $word = 'x'"
)
PARAMS = "".join(
    f'[params.{name}]\ndefault = {value}\nunit = ""\nwhy = "a test"\n'
    for name, value in (("limit", 1), ("on", "true"), ("word", '"x"'))
)


@pytest.fixture
def rules(tmp_path: Path) -> dict[str, Rule]:
    head = INVARIANT | MEASURE | {"reads": '["ego_state"]'}
    made = [
        write(tmp_path, head | {"status": f'"{status}"'} | more, {"condition": SQL}, name=name, tables=PARAMS)
        for name, status, more in (
            ("r2.gap", "stable", {"clause": '"UKHC R2 and R10: keep away"', "requires": '["map"]'}),
            ("r1.speed", "stable", {"severity": '"critical"', "clause": '"StVO 3(2): be slow"'}),
            ("r3.new", "draft", {"legal": '"should"', "severity": '"critical"'}),
            ("r4.old", "deprecated", {}),
        )
    ]
    return {rule.id: rule for rule in made}


@pytest.mark.parametrize(
    ("include", "ignore", "expected"),
    [
        ([], [], ["pack.r1.speed", "pack.r2.gap"]),
        (["pack"], [], ["pack.r1.speed", "pack.r2.gap", "pack.r3.new"]),
        (["pack.r3.new"], [], ["pack.r3.new"]),
        (["*.r4.old"], ["pack.r1.speed"], None),
        (["pack.r4.old"], [], ["pack.r4.old"]),
        (["pack.r*"], ["*.gap", "pack.r3.new"], ["pack.r1.speed"]),
        (["pack.r2.gap", "pack.r2.gap", "*speed"], [], ["pack.r1.speed", "pack.r2.gap"]),
        (["pack.r2.gap"], ["pack"], None),
        (["all"], [], ["pack.r1.speed", "pack.r2.gap", "pack.r3.new"]),
        (["kind:invariant"], ["status:draft"], ["pack.r1.speed", "pack.r2.gap"]),
        (["severity:critical"], [], ["pack.r1.speed", "pack.r3.new"]),
        (["severity:critical,status:draft"], [], ["pack.r3.new"]),
        (["pack, legal:must", "pack.r3.new"], ["severity:critical,legal:should"], ["pack.r1.speed", "pack.r2.gap"]),
        (["clause:R10"], [], ["pack.r2.gap"]),
        (["clause:r1"], [], ["pack.r1.speed"]),
        (["clause:3(2)"], [], ["pack.r1.speed"]),
        (["requires:map"], [], ["pack.r2.gap"]),
        (["status:deprecated"], [], ["pack.r4.old"]),
    ],
)
def test_select(rules: dict[str, Rule], include: list[str], ignore: list[str], expected: list[str] | None) -> None:
    if expected is None:
        with pytest.raises(UsageError, match="no rule is left"):
            select_rules(rules, include, ignore, default_pack="pack")
    else:
        assert [rule.id for rule in select_rules(rules, include, ignore, default_pack="pack")] == expected


@pytest.mark.parametrize(
    ("include", "ignore", "required", "expected"),
    [
        (["pack"], [], ["pack.r1.speed"], ("pack.r1.speed",)),
        (["pack"], [], ["legal:must", "pack.r1.*"], None),
        (["pack"], ["pack.r2.gap"], ["pack"], ("pack.r1.speed",)),
        (["pack"], ["pack.r2.gap"], ["pack.r2.gap"], "pack.r2.gap"),
        (["pack.r1.speed"], [], ["pack"], ("pack.r1.speed",)),
        (["pack.r1.speed"], [], ["pack.r2.*"], "pack.r2.gap"),
        (["pack.r1.speed"], [], ["pack.r2.gap"], "pack.r2.gap"),
        (["pack"], [], ["pack.r3.new"], "not a stable rule"),
        (["pack"], ["pack.r1.*"], ["pack.r1.*"], "excludes all of its rules"),
        (["pack"], [], ["pack.r9"], "no rule, pack or glob"),
        (["pack"], [], [], ()),
    ],
)
def test_what_is_required_is_stable_and_selected(
    rules: dict[str, Rule], include: list[str], ignore: list[str], required: list[str], expected: object
) -> None:
    selected = select_rules(rules, include, ignore)
    if isinstance(expected, str):
        with pytest.raises(UsageError, match=expected):
            required_rules(rules, selected, required, ignore)
    else:
        musts = tuple(rule.id for rule in selected if rule.legal == "must" and rule.status == "stable")
        either = tuple(sorted({*musts, "pack.r1.speed"}))
        assert required_rules(rules, selected, required, ignore) == (either if expected is None else expected)


@pytest.mark.parametrize(
    ("selector", "nearest"),
    [("pack.r1.sped", "pack.r1.speed"), ("pac", "pack"), ("r2.gap", "pack.r2.gap"), ("r1", "pack.r1.speed")],
)
def test_a_selector_that_matches_nothing_is_refused_with_the_nearest(
    rules: dict[str, Rule], selector: str, nearest: str
) -> None:
    for include, ignore in (([selector], []), ([], [selector])):
        with pytest.raises(UsageError, match=f"did you mean '{nearest}'"):
            select_rules(rules, include, ignore, default_pack="pack")


@pytest.mark.parametrize(
    ("selector", "says"),
    [
        ("knd:invariant", "rules are not selected by 'knd'; did you mean 'kind'"),
        ("zzz:1", "known are kind, subtype, severity, status, legal, derivation, clause, requires"),
        ("severity:crit", "no rule has the severity 'crit'; did you mean 'critical'"),
        ("requires:zzz", "no rule has the requires 'zzz'; known are map"),
        ("pack,severity:minor", "no rule has the severity 'minor'; "),
        (
            "clause:R10,status:draft",
            "'clause:R10,status:draft': each part alone selects some; for any of them, repeat --rules",
        ),
        ("pack,", "no rule, pack or glob matches ''"),
        ("[" * 60_000, "has 60000 characters: use at most 1000"),
    ],
)
def test_what_a_selector_asks_for_must_exist(rules: dict[str, Rule], selector: str, says: str) -> None:
    with pytest.raises(UsageError, match=says.replace("(", r"\(")):
        select_rules(rules, [selector], [], default_pack="pack")


def test_parameters_are_typed_like_their_default(rules: dict[str, Rule]) -> None:
    settings = ["pack.r1.speed.limit=2.5", "pack.r1.speed.on=FALSE", "pack.r2.gap.word=a=b"]
    assert parse_params(rules.values(), settings) == {
        "pack.r1.speed": {"limit": 2.5, "on": False},
        "pack.r2.gap": {"word": "a=b"},
    }


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("limit", "write RULE.PARAM=VALUE"),
        ("pack.r1.sped.limit=1", "did you mean 'pack.r1.speed'"),
        ("pack.r1.speed.limt=1", "has no parameter 'limt'; it has: limit, on, word"),
        ("pack.r1.speed.limit=fast", "'fast' is not a number"),
        ("pack.r1.speed.limit=nan", "must be a finite number"),
        ("pack.r1.speed.on=1", "must be true or false"),
    ],
)
def test_wrong_parameters(rules: dict[str, Rule], setting: str, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        parse_params(rules.values(), [setting])
