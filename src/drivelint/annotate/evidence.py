"""Reads what annotated logs need from the database while a batch of drives is in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.result import collect

if TYPE_CHECKING:
    from collections.abc import Sequence

    import duckdb

_SPACES: Final = """
SELECT o.drive_id, o.ego_id, o.t_ns, any_value(e.chain_id) AS chain_id, any_value(o.ds_av_s_m) AS s_m, any_value(o.ds_av_d_m) AS d_m,
    any_value(o.ds_av_half_m) AS half_m, max(o.sd_av_m) AS sd_av_m, max(o.sd_ov_m) AS sd_ov_m, min(o.stage) AS stage,
    list(DISTINCT o.vbp_id ORDER BY o.vbp_id) AS vbp_ids, min(o.ov_id) AS ov_id, any_value(o.ds_ov_s_m) AS ov_s_m,
    any_value(o.ds_ov_d_m) AS ov_d_m, any_value(o.ds_ov_half_m) AS ov_half_m,
    bool_or(coalesce(o.vbp_in_ds_av_m >= 0, false) OR coalesce(o.ov_in_ds_av_m >= 0, false)) AS av_met,
    bool_or(coalesce(o.av_in_ds_ov_m >= 0, false)) AS ov_met,
    bool_or(coalesce(o.ds_overlap_m >= 0, false)) AS overlap
FROM overtake_step o
JOIN ego_state e USING (drive_id, ego_id, t_ns)
WHERE list_contains(?, o.drive_id)
GROUP BY o.drive_id, o.ego_id, o.t_ns
ORDER BY o.drive_id, o.ego_id, o.t_ns
"""

_CHAINS: Final = """
SELECT c.drive_id, c.ego_id, c.chain_id, c.s_start_m + p.s_m AS s_m, p.x_m, p.y_m, p.z_m, p.tx, p.ty
FROM corridor c
SEMI JOIN (
    SELECT e.drive_id, e.ego_id, e.chain_id
    FROM overtake_step o JOIN ego_state e USING (drive_id, ego_id, t_ns)
) u ON u.drive_id = c.drive_id AND u.ego_id = c.ego_id AND u.chain_id = c.chain_id
JOIN data_log l ON l.drive_id = c.drive_id
JOIN lane_point p ON p.environment_id = l.environment_id AND p.lanelet_id = c.lanelet_id
WHERE list_contains(?, c.drive_id)
ORDER BY c.drive_id, c.ego_id, c.chain_id, c.seq, p.k
"""


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
    ids = list(drive_ids)
    return con.execute(_SPACES, [ids]).to_arrow_table(), con.execute(_CHAINS, [ids]).to_arrow_table()


def gather_evidence(
    con: duckdb.DuckDBPyConnection, drive_ids: Sequence[str], spaces: Sequence[tuple[pa.Table, pa.Table]]
) -> dict[str, Evidence]:
    """Return the evidence of every drive of a batch whose last part was just judged. `spaces`: `danger_spaces` of each part."""
    ids = list(drive_ids)
    tables = [collect.verdicts(con, ids), collect.findings(con, ids), collect.drives(con, ids)]
    tables += [pa.concat_tables(parts) for parts in zip(*spaces, strict=True)]
    return {drive: Evidence(*(rows.filter(pc.equal(rows["drive_id"], drive)) for rows in tables)) for drive in ids}
