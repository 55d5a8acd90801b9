"""Makes the rows of `rules.parquet`: the selected rules with the parameters that were used."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyarrow as pa

from drivelint.result.schemas import arrow_schema

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule


def rule_table(rules: Sequence[Rule], params: Mapping[str, Mapping[str, object]], profiles: Sequence[str]) -> pa.Table:
    """Return one row of the table `rule` per rule, sorted by id."""
    rows = [_row(rule, params.get(rule.id, {}), profiles) for rule in sorted(rules, key=lambda r: r.id)]
    return pa.Table.from_pylist(rows, schema=arrow_schema("rule"))


def _row(rule: Rule, overrides: Mapping[str, object], profiles: Sequence[str]) -> dict[str, object]:
    values = {name: overrides.get(name, param.default) for name, param in rule.params.items()}
    same = (
        "pack", "pack_title", "title", "clause", "hypothesis", "kind", "subtype", "derivation", "severity", "legal", "status",
        "sense", "unit", "observes", "near_margin",
    )  # fmt: skip
    window = values.get(rule.window_s) if isinstance(rule.window_s, str) else rule.window_s
    return {key: getattr(rule, key) for key in same} | {
        "rule_id": rule.id,
        "rule_version": rule.version,
        "window_s": window,
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
