"""Reads what annotated logs need from the database while a batch of drives is in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.result import collect
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb


@dataclass(frozen=True)
class Evidence:
    """What was found in one drive: its rows of the output tables, danger spaces in overtakes and the chains they lie on."""

    verdicts: pa.Table
    findings: pa.Table
    drive: pa.Table
    spaces: pa.Table
    chains: pa.Table


def danger_spaces(con: duckdb.DuckDBPyConnection, drive_ids: Sequence[str]) -> tuple[pa.Table, pa.Table]:
    """Return the danger spaces of these drives and the chains they lie on, while the database still has them."""
    ids = {"ids": list(drive_ids)}
    spaces = con.execute(statement("evidence/overtake_space"), ids).to_arrow_table()
    return spaces, con.execute(statement("evidence/chain_point"), ids).to_arrow_table()


def gather_evidence(
    con: duckdb.DuckDBPyConnection, drive_ids: Sequence[str], spaces: Sequence[tuple[pa.Table, pa.Table]]
) -> dict[str, Evidence]:
    """Return the evidence of every drive of a batch whose last part was just judged. `spaces`: `danger_spaces` of each part."""
    ids = list(drive_ids)
    tables = [collect.verdicts(con, ids), collect.findings(con, ids), collect.drives(con, ids)]
    tables += [pa.concat_tables(parts) for parts in zip(*spaces, strict=True)]
    return {drive: Evidence(*(rows.filter(pc.equal(rows["drive_id"], drive)) for rows in tables)) for drive in ids}
