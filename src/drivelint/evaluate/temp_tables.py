"""Creates and drops the temporary tables of an evaluation."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from drivelint.catalogue.header import CONTACT_TAG, JUDGES_STANDING_EGO_TAG, ROAD_USERS_SIGNAL
from drivelint.drive import conditions
from drivelint.evaluate import applicability
from drivelint.reasons.signals import SIGNALS_OF_FEW_LOGS
from drivelint.sql import store
from drivelint.sql.derivations import tables_with_sources
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

    from drivelint.evaluate.sql_fragments import Binding

OUTCOME_TABLES = ("_error", "_group", "_outcome", "_stretch", "_course", "_margin")
"""Tables with the results of rules. The rows of a second connection are appended to those of the first."""
_ALLOWED_WORD_SCHEMA = pa.schema(
    [("rule_no", pa.int32()), *((name, pa.string()) for name in ("code", "condition", "word"))]
)
_QUANTITY_SCHEMA = pa.schema([("rule_no", pa.int32()), ("quantity", pa.string())])


def create_tables_and_count_subjects(
    con: duckdb.DuckDBPyConnection, bindings: Sequence[Binding]
) -> tuple[dict[int, int], set[int]]:
    """Create the temporary tables of an evaluation.

    Return rule number -> number of subjects to judge, and the numbers of the rules whose conditions are met at no step of these subjects.
    """
    con.execute(statement("judging/tables"))
    # as Arrow tables, because binding a list as a parameter takes a tenth of a second
    store.insert(con, "_rule", _rule_rows(bindings))
    store.insert(con, "_needs", _required_signal_rows(bindings))
    store.insert(con, "_allowed", _rows_of_allowed_condition_values(bindings))
    con.execute(statement("judging/todo"))
    sql = """
        SELECT rule_no, count(*), count(o.rule_no)
        FROM _todo t LEFT JOIN (FROM _ruled_out WHERE code = 'outside_conditions') o USING (rule_no, drive_id, ego_id)
        GROUP BY rule_no
    """
    counts = con.execute(sql).fetchall()
    return {int(no): int(n) for no, n, _ in counts}, {int(no) for no, n, n_outside in counts if n == n_outside}


def create_table_of_doubted_steps(con: duckdb.DuckDBPyConnection, bindings: Sequence[Binding]) -> None:
    """Create the table of the steps that rules must not judge, because a quantity that they use is doubtful there."""
    with store.registered(con, {"_rule_quantity": _rows_of_used_quantity_names(bindings)}):
        con.execute(statement("judging/doubted"))


def _rule_rows(bindings: Sequence[Binding]) -> pa.Table:
    fields = (
        "kind",
        "subtype",
        "severity",
        "sense",
        "unit",
        "observes",
        "near_margin",
        "without_time",
        "without_anchor",
    )
    rows = []
    for binding in bindings:
        rule, sources = binding.rule, tables_with_sources(binding.rule.reads)
        row = {"rule_no": binding.no, "rule_id": rule.id, "rule_version": rule.version}
        row |= {name: getattr(rule, name) for name in fields}
        row |= {"of_others": ROAD_USERS_SIGNAL in rule.needed_signals, "of_hidden": "hidden" in sources}
        row |= {
            "of_lanes": bool({"registration", "way"} & set(rule.requires)),
            "of_contact": CONTACT_TAG in rule.tags,
            "of_standing": JUDGES_STANDING_EGO_TAG in rule.tags,
        }
        row |= {"by_object": rule.combine == "each", "eventually": rule.quantifier == "eventually"}
        row |= {"own_grid": "applies" in rule.sections}
        row |= {"merge_ns": binding.values(["_merge_ns"])["_merge_ns"]}
        limits = applicability.parameters_of_conditions(rule)
        rows.append(row | {"limit_min_mps": limits["_limit_min"], "limit_max_mps": limits["_limit_max"]})
    return pa.Table.from_pylist(rows)


def _required_signal_rows(bindings: Sequence[Binding]) -> pa.Table:
    return pa.Table.from_pylist([
        {
            "rule_no": b.no, "pos": pos, "signal": signal, "is_assumed": signal == ROAD_USERS_SIGNAL,
            "may_be_unrecorded": signal in SIGNALS_OF_FEW_LOGS and not b.rule.is_named,
        }
        for b in bindings
        for pos, signal in enumerate(b.rule.needed_signals)
    ])  # fmt: skip


def _rows_of_used_quantity_names(bindings: Sequence[Binding]) -> pa.Table:
    pairs = [(b.no, quantity) for b in bindings for quantity in sorted(b.rule.quantities)]
    return pa.table([[no for no, _ in pairs], [quantity for _, quantity in pairs]], schema=_QUANTITY_SCHEMA)


def _rows_of_allowed_condition_values(bindings: Sequence[Binding]) -> pa.Table:
    """Return the words that each rule's law and conditions allow, and more general words, which may include an allowed one."""
    columns = ("rule_no", "code", "condition", "word")
    rows = []
    for b in bindings:
        restrictions = [
            ("outside_conditions", *restriction) for restriction in b.rule.applies.restricted_conditions.items()
        ]
        if b.rule.law:
            restrictions.append(("other_nation", "nation", b.rule.law))
        for code, condition, words in restrictions:
            spellings = (*conditions.with_narrower_values(words), *conditions.broader_values(words))
            rows += [(b.no, code, condition, word) for word in spellings]
    return pa.table({name: [row[at] for row in rows] for at, name in enumerate(columns)}, schema=_ALLOWED_WORD_SCHEMA)
