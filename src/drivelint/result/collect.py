"""Makes output tables: verdicts, findings and drives, from a database with verdicts; and the selected rules."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyarrow as pa

from drivelint.drive.trace import ASIDE_OF_LANE_CHECK, LOSS_CHECKS
from drivelint.reasons.reason_table import make_reason_table
from drivelint.result.schemas import conform
from drivelint.sql.statements import statement
from drivelint.sql.store import arrow_schemas

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import duckdb

    from drivelint.catalogue import Rule

ORDER_OF_VERDICTS: Final = (
    "drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, occurrence, ref_id NULLS FIRST, "
    "t_start_ns NULLS FIRST"
)
ORDER_OF_FINDINGS: Final = f"{ORDER_OF_VERDICTS}, finding_id"

_IS_CHOSEN_DRIVE: Final = "coalesce(list_contains($only::VARCHAR[], drive_id), true)"  # NULL selects every drive


def verdicts(con: duckdb.DuckDBPyConnection, drive_ids: list[str] | None = None) -> pa.Table:
    """Return the table `verdict`, totally ordered, for the drives `drive_ids`; None: for all drives."""
    rows = con.execute(
        f"SELECT * FROM verdict WHERE {_IS_CHOSEN_DRIVE} ORDER BY {ORDER_OF_VERDICTS}", {"only": drive_ids}
    )
    return conform(rows.to_arrow_table(), "verdict")


def findings(con: duckdb.DuckDBPyConnection, drive_ids: list[str] | None = None) -> pa.Table:
    """Return the table `finding`, totally ordered, for the drives `drive_ids`; None: for all drives."""
    rows = con.execute(
        f"SELECT * FROM finding WHERE {_IS_CHOSEN_DRIVE} ORDER BY {ORDER_OF_FINDINGS}", {"only": drive_ids}
    )
    return conform(rows.to_arrow_table(), "finding")


def drives(con: duckdb.DuckDBPyConnection, drive_ids: list[str] | None = None) -> pa.Table:
    """Return the table `drive`, ordered, with one row per drive in `drive_ids`; None: one row per drive in the database."""
    make_reason_table(con, "SELECT NULL AS rule_no, reason AS cause, 0 AS start_ns FROM capability WHERE NOT available")
    rows = con.execute(
        statement("evidence/drive"), {"only": drive_ids, "losses": LOSS_CHECKS, "aside_check": ASIDE_OF_LANE_CHECK}
    )
    return conform(rows.to_arrow_table(), "drive")


def unjudged_drive(drive_id: str, file_name: str, reason: str, sha256: str | None = None) -> pa.Table:
    """Return the row of the table `drive`, including the reason, for a log that could not be judged at all."""
    schema = arrow_schemas()["drive"]
    row = dict.fromkeys(schema.names)
    row |= {key: [] for key in ("conditions", "exposure", "occasions", "quality", "not_judged", "recorded")}
    row |= dict.fromkeys(("n_states", "n_steps", "n_egos"), 0)
    texts = {"drive_id": drive_id, "file_name": file_name, "status_reason": reason}
    row |= {
        key: text.encode("utf-8", "backslashreplace").decode() for key, text in texts.items()
    }  # a file name may contain any bytes
    row |= {"sha256": sha256, "km": 0.0, "lossy": False, "status": "not_judged"}
    return pa.Table.from_pylist([row], schema=schema)


def rule_table(rules: Sequence[Rule], params: Mapping[str, Mapping[str, object]], profiles: Sequence[str]) -> pa.Table:
    """Return the table `rule`, sorted by id: one row per rule, with the parameters that the run used."""
    rows = [_rule_row(rule, params.get(rule.id, {}), profiles) for rule in sorted(rules, key=lambda r: r.id)]
    return pa.Table.from_pylist(rows, schema=arrow_schemas()["rule"])


def _rule_row(rule: Rule, overrides: Mapping[str, object], profiles: Sequence[str]) -> dict[str, object]:
    values = {name: overrides.get(name, param.default) for name, param in rule.params.items()}
    same = (
        "pack", "pack_title", "title", "breach", "clause", "hypothesis", "kind", "subtype", "derivation", "severity", "legal", "status",
        "is_named", "sense", "unit", "observes", "near_margin",
    )  # fmt: skip
    window = values.get(rule.window_s) if isinstance(rule.window_s, str) else rule.window_s
    return {key: getattr(rule, key) for key in same} | {
        "rule_id": rule.id,
        "rule_version": rule.version,
        "window_s": window,
        "law": list(rule.law),
        "tags": list(rule.tags),
        "requires": list(rule.requires),
        "profiles": sorted(profiles) if rule.per_profile else [],
        "params": [
            {
                "name": name,
                "value": str(value).lower() if isinstance(value, bool) else str(value),
                "unit": rule.params[name].unit,
                "overridden": name in overrides,
            }
            for name, value in sorted(values.items())
        ],
    }
