"""Builds SQL fragments that all kinds of rules use.

The text of a rule was checked when it was loaded, so it is inserted into the statement as a CTE. Values are always bound.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.errors import UsageError
from drivelint.evaluate import applicability
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from drivelint.catalogue import Rule

_NS_PER_S = 1_000_000_000
_PROFILE_JOIN = (
    "JOIN (SELECT drive_id, ego_id, profile FROM _profile_set WHERE rule_no = $_no) p USING (drive_id, ego_id)"
)
_REFERENCE_STEP_CTE = (
    "reference_step AS NOT MATERIALIZED (SELECT * EXCLUDE (rule_no) FROM _reference_step WHERE rule_no = $_no), "
)
"""The CTE with the steps of a rule's reference points, which its condition reads. DuckDB materializes CTEs that are read twice by default,
and does not filter them."""
_PARAMETER_BY_FIELD = {"window_s": "_window_ns", "exempt_after_s": "_exempt_ns", "merge_gap_s": "_merge_ns"}


class Binding:
    """A rule in this evaluation: its number and the values that its statements bind.

    `overrides`: parameter -> the user's value. Errors: `UsageError` for an unknown parameter or an invalid time.
    """

    def __init__(self, rule: Rule, no: int, overrides: Mapping[str, object]) -> None:
        self.rule = rule
        self.no = no
        unknown = sorted(overrides.keys() - rule.params.keys())
        if unknown:
            raise UsageError(
                f"rule {rule.id} has no parameter {unknown[0]!r}; it has: {', '.join(rule.params) or 'none'}"
            )
        params: dict[str, object] = {name: param.default for name, param in rule.params.items()} | dict(overrides)
        self._values: dict[str, object] = {
            **params,
            "_no": no,
            "_sense": rule.sense,
            "_all": rule.combine == "all",
            "_combined": rule.combine != "each",
            **applicability.parameters_of_conditions(rule),
        }
        for field, name in _PARAMETER_BY_FIELD.items():
            duration = getattr(rule, field)
            seconds = params[duration] if isinstance(duration, str) else duration
            self._values[name] = None if seconds is None else _nanoseconds(seconds, rule.id, field)

    def values(self, names: Iterable[str]) -> dict[str, object]:
        """Return the values of these parameters only, because DuckDB rejects additional ones."""
        return {name: self._values[name] for name in names}


def _nanoseconds(seconds: object, rule_id: str, field: str) -> int:
    if isinstance(seconds, bool) or not isinstance(seconds, int | float) or not 0 <= seconds < _NS_PER_S:
        raise UsageError(f"rule {rule_id}: {field} must be a number of seconds, not {seconds!r}")
    return round(seconds * _NS_PER_S)


def rule_statement(name: str, rule: Rule, **fragments: str) -> str:
    """Return `queries/judging/<name>.sql` for a rule, with its condition, its profiles, and `condition_sql_fragments` filled in."""
    return statement(
        f"judging/{name}",
        condition=f"{_REFERENCE_STEP_CTE if rule.kind != 'invariant' else ''}{condition_ctes_sql(rule)}",
        profile="p.profile" if rule.per_profile else "''",
        profiles=_PROFILE_JOIN if rule.per_profile else "",
        **fragments,
    )


def condition_ctes_sql(rule: Rule) -> str:
    """Return the CTEs `_condition` and `_state` of a rule.

    `_state`: drive_id, ego_id, t_ns, object_id, ref_id, profile (NULL: none), applies, observed, required, holds (NULL: unknown), gain (the
    signed margin, possibly infinite; 0 for sense = holds), code, reason (the author's, or NULL).

    NaN becomes NULL. So does negative infinity, which is no valid measure, if it would satisfy any limit. A limit that is missed by at most
    the `error` of the value gives unknown. A value that is only a lower bound can prove a pass for > and >=, and a violation for < and <=;
    otherwise the result is unknown.
    """
    has = rule.has_column
    is_measured = rule.sense != "holds"
    # for >= and <=, values are rounded, so that 1.5 m satisfies "at least 1.5 m" in spite of rounding errors
    exact = "{0}::DOUBLE" if rule.sense in {">", "<"} else "round({0}::DOUBLE, 9)"
    number = f"CASE WHEN isnan({{0}}::DOUBLE){{1}} THEN NULL ELSE {exact} END AS {{0}}"
    keeps_all = {"required" if rule.sense[0] == ">" else "observed": " OR {0}::DOUBLE = '-Infinity'::DOUBLE"}
    columns = [
        "drive_id::VARCHAR AS drive_id", "ego_id::VARCHAR AS ego_id", "t_ns::BIGINT AS t_ns",
        f"{'bounded_text(object_id)' if has('object_id') else 'NULL::VARCHAR'} AS object_id",
        f"{'ref_id' if has('ref_id') else 'NULL'}::INTEGER AS ref_id",
        f"{'bounded_text(profile)' if has('profile') else 'NULL::VARCHAR'} AS profile",
        f"{'applies' if has('applies') else 'true'}::BOOLEAN AS applies",
        *(
            number.format(column, keeps_all.get(column, "").format(column)) if is_measured else f"NULL::DOUBLE AS {column}"
            for column in ("observed", "required")
        ),
        *(["holds::BOOLEAN AS holds"] if not is_measured else []),
        *(["coalesce(at_least::BOOLEAN, true) AS at_least"] if has("at_least") else []),
        *(["coalesce(error::DOUBLE, 0.0) AS error"] if has("error") else []),
        f"{'bounded_text(reason_code)' if has('reason_code') else 'NULL::VARCHAR'} AS code",
        f"{'bounded_text(reason)' if has('reason') else 'NULL::VARCHAR'} AS reason",
    ]  # fmt: skip
    holds, gain, code = "holds", "0.0::DOUBLE", "code"
    if is_measured:
        holds = compare = f"(observed {rule.sense} required)"
        difference = "observed - required" if rule.sense[0] == ">" else "required - observed"
        gain = f"CASE WHEN isnan({difference}) THEN 0.0::DOUBLE ELSE {difference} END"
        if has("error"):
            holds = f"CASE WHEN {compare} OR error = 0 OR abs({difference}) > error THEN {compare} END"
            code = f"coalesce(code, CASE WHEN ({holds}) IS NULL AND {compare} IS NOT NULL THEN 'within_error' END)"
        if has("at_least"):
            proven = f"{compare}" if rule.sense[0] == ">" else f"NOT {compare}"
            holds = f"CASE WHEN NOT at_least OR ({proven}) THEN {compare} END"
            # the value is known as a bound only, which does not decide
            code = f"coalesce(code, CASE WHEN ({holds}) IS NULL AND {compare} IS NOT NULL THEN 'only_a_bound' END)"
    return f"""_condition AS (
{rule.sections["condition"]}
), _value AS (SELECT {", ".join(columns)} FROM _condition
), _state AS (SELECT drive_id, ego_id, t_ns, object_id, ref_id, profile, applies, observed, required,
    {holds} AS holds, {gain} AS gain, {code} AS code, reason FROM _value)"""


def subject_join_sql(skips_subjects: bool, alias: str) -> str:
    """Return the semi-join that keeps the subjects that the rule has to judge; '' if it judges all (`skips_subjects` is False)."""
    if not skips_subjects:
        return ""
    subjects = "(SELECT drive_id, ego_id FROM _todo WHERE rule_no = $_no) _t"
    return f" SEMI JOIN {subjects} ON {alias}.drive_id = _t.drive_id AND {alias}.ego_id = _t.ego_id"


def deciding_step_sql(rule: Rule) -> str:
    """Return the aggregate that selects the deciding step of `_state`, like the macro `deciding_step_sql`, but without `who`."""
    eventually = rule.quantifier == "eventually"
    good, bad = (0, 1) if eventually else (1, 0)
    unknown = 2
    if rule.sense == "holds":
        good, unknown, bad = (0, 1, 2) if eventually else (2, 1, 0)
    return step_by_rank_sql(good, bad, unknown, "-" if eventually else "", "")


def step_by_rank_sql(good: int, bad: int, unknown: int, sign: str, object_fields: str) -> str:
    """Return the aggregate that selects a step by these ranks, then by margin, time and `object_fields`.

    `good`, `bad`, `unknown`: the ranks by result, the lowest first. `sign`: '-' for the largest margin first, else ''. `object_fields`: SQL
    of struct fields about the object, or ''.
    """
    return (
        f"min({{'b': CASE WHEN holds THEN {good} WHEN NOT holds THEN {bad} ELSE {unknown} END, "
        f"'g': CASE WHEN holds IS NULL THEN 0.0::DOUBLE ELSE {sign}gain END, 't': coalesce(t_ns, unknown_time_ns()), "
        f"{object_fields}'observed': observed, 'required': required, 'holds': holds, 'code': code, 'reason': reason}})"
    )
