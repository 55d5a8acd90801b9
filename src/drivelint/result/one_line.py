"""Prepares a result for line-based output: text from a log or rule cannot add a line that looks like drivelint's own."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.phrases import one_line

if TYPE_CHECKING:
    from drivelint.result.model import Result


def result_on_one_line(result: Result) -> Result:
    """Return the result with every text of verdicts, findings, drives and rules on one line."""
    tables = {name: _columns_on_one_line(getattr(result, name)) for name in ("verdicts", "findings", "rules")}
    return replace(result, drives=_columns_on_one_line(_nested_columns_on_one_line(result.drives)), **tables)


def _columns_on_one_line(rows: pa.Table) -> pa.Table:
    for no, field in enumerate(rows.schema):
        if pa.types.is_string(field.type) and pc.any(pc.match_substring(rows.column(no), "\n")).as_py():
            texts = [text and one_line(text) for text in rows.column(no).to_pylist()]
            rows = rows.set_column(no, field, pa.array(texts, field.type))
    return rows


def _nested_columns_on_one_line(drives: pa.Table) -> pa.Table:
    for no, field in enumerate(drives.schema):
        if pa.types.is_nested(field.type):
            drives = drives.set_column(
                no, field, pa.array(nested_texts_on_one_line(drives.column(no).to_pylist()), field.type)
            )
    return drives


def nested_texts_on_one_line(value: Any) -> Any:
    """Return a nested value with every text in it on one line."""
    if isinstance(value, str):
        return one_line(value)
    if isinstance(value, list | tuple):
        return type(value)(nested_texts_on_one_line(item) for item in value)
    return {key: nested_texts_on_one_line(item) for key, item in value.items()} if isinstance(value, dict) else value
