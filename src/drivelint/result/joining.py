"""Joins the results of parts of a run: the joined tables equal the tables of one run over all logs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import pyarrow as pa

from drivelint.result import collect, evidence
from drivelint.sql import store

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.result.model import Result

_ORDER_OF_ROWS: Final = {
    "verdicts": collect.ORDER_OF_VERDICTS,
    "findings": collect.ORDER_OF_FINDINGS,
    "drives": "drive_id, file_name",
    **evidence.ORDER_OF_ROWS,
    "pictures": "drive_id, t_ns, camera_no, t_frame_ns",
}
"""Table -> the order of its rows."""


def join_results(results: Sequence[Result]) -> Result:
    """Return one result from several results without common drives; settings and notes are from the first result.

    The lanes of a map that occurs in several results are included once.
    """
    first = results[0]
    with store.connect(threads=1) as con:
        tables = {}
        for name, order in _ORDER_OF_ROWS.items():
            con.register("_rows", pa.concat_tables([getattr(result, name) for result in results]))
            once = f"DISTINCT ON ({order})" if name == "lanes" else ""
            tables[name] = con.execute(f"SELECT {once} * FROM _rows ORDER BY {order}").to_arrow_table()
            con.unregister("_rows")
    options = [result.run_options for result in results if result.run_options is not None]
    if options:
        traces = {drive: path for request in reversed(options) for drive, path in request.traces.items()}
        paths = {drive: path for request in reversed(options) for drive, path in request.relative_paths.items()}
        manifest_options = {
            drive: options_of_drive
            for request in reversed(options)
            for drive, options_of_drive in request.manifest_options.items()
        }
        tables["run_options"] = replace(
            options[0], traces=traces, relative_paths=dict(sorted(paths.items())), manifest_options=manifest_options
        )
    return replace(first, **tables, interrupted=any(result.interrupted for result in results))
