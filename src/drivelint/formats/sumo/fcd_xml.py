"""Reads SUMO's floating car data in XML: line by line where all vehicles look like the first, else by the parser."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv

from drivelint.errors import TraceError
from drivelint.formats import safe_xml
from drivelint.formats.sumo.clock import seconds_of_texts
from drivelint.formats.sumo.end_tag import with_end_tag
from drivelint.formats.sumo.rows import ATTRIBUTES, KINDS, VEHICLE, Rows, typed_rows

if TYPE_CHECKING:
    from pathlib import Path

ROOT_TAG: Final = "fcd-export"
_STEP_END_PATTERN: Final = r"</timestep>|<timestep\s[^<>]*/>"
_STEP_TAG: Final = re.compile(r'<timestep +time="([^"]*)" *(/?)>')
_FCD_OPTION: Final = re.compile(rb'<(fcd-output(?:\.geo)?) +value="([^"]*)"')
_SELECTION_OPTION: Final = re.compile(
    rb"<((?:person-)?device\.fcd\.(?:probability|explicit)|fcd-output\.filter-(?:edges\.input-file|shapes)|person-fcd-output)"
    rb' +value="([^"]+)"'
)
"""The options with which SUMO writes only some of the road users into the file."""
_TRUE_WORDS: Final = frozenset({b"1", b"yes", b"true", b"on", b"x", b"t"})


def read_xml(path: Path) -> Rows:
    """Read a log. Errors: `TraceError` if it is not well-formed, or a value is not a number."""
    content, lacks_end = with_end_tag(path.read_bytes(), ROOT_TAG, _STEP_END_PATTERN)
    columns = columns_from_lines(content)
    if columns is None:
        columns, kind = parse_columns_and_kinds(path, content)
    else:
        kind = np.full(len(columns["time"]), VEHICLE, np.int8)
    rows = typed_rows(path, columns, kind)
    head = content[: content.find(f"<{ROOT_TAG}".encode())]
    return rows._replace(
        geo_option=_has_geo_option(head), selection_options=_selection_options(head), lacks_end=lacks_end
    )


def _has_geo_option(head: bytes) -> bool | None:
    """Return whether SUMO's configuration, a comment before the data, asks for longitude and latitude; None without a configuration."""
    options = dict(_FCD_OPTION.findall(head))
    return options.get(b"fcd-output.geo", b"").lower() in _TRUE_WORDS if options else None


def _selection_options(head: bytes) -> tuple[str, ...]:
    """Return the options of SUMO's configuration by which some road users are not written, as `name=value`."""
    options = [(name.decode(), value.decode("utf-8", "replace")) for name, value in _SELECTION_OPTION.findall(head)]
    # a negative probability is SUMO's default, with which every road user is written
    return tuple(
        f"{name}={value}"
        for name, value in options
        if not (name.endswith("probability") and not 0.0 <= safe_xml.number_or_nan(value) < 1.0)
    )


def columns_from_lines(content: bytes) -> dict[str, pa.ChunkedArray | pa.Array] | None:
    """Read a log with one element per line as CSV with the quotation mark as separator; None if any line looks different."""
    begin = content.find(b"<fcd-export")
    first = re.search(rb'^[ \t]*<vehicle(?: +[\w:.-]+="[^"<\n]*")+ */>(?=\r?$)', content[begin:], re.MULTILINE)
    if first is None or b"&" in content or not _is_valid_utf8_head(content[: content.find(b">", begin) + 1]):
        return None
    parts = first[0].decode("utf-8", "replace").split('"')
    names = [part.split()[-1].removesuffix("=") for part in parts[:-1:2]]
    if len(set(names)) < len(names):
        return None
    columns = [f"{i}" for i in range(len(parts))]
    other_lines: list[tuple[int, str]] = []

    def keep_line_without_vehicle(row: Any) -> str:
        other_lines.append((row.number, row.text.strip()))
        return "skip"

    read_columns = [c for i, c in enumerate(columns) if i % 2 == 0 or names[i // 2] in ATTRIBUTES]
    try:
        table = pa_csv.read_csv(
            pa.BufferReader(memoryview(content)[begin:]),
            # one thread, because only then line numbers are known
            pa_csv.ReadOptions(column_names=columns, use_threads=False, block_size=1 << 24),
            pa_csv.ParseOptions(
                delimiter='"', quote_char=False, ignore_empty_lines=False, invalid_row_handler=keep_line_without_vehicle
            ),
            pa_csv.ConvertOptions(
                column_types=dict.fromkeys(read_columns, pa.string()),
                include_columns=read_columns,
                strings_can_be_null=False,
            ),
        )
        times = _times_of_vehicles(other_lines, len(table))
    except pa.ArrowInvalid:
        return None
    alike = (pc.equal(table.column(column), part) for column, part in zip(columns[::2], parts[::2], strict=True))
    more = content.count(b"<", begin) > len(table) + len(other_lines)  # there are more elements than lines
    if times is None or more or not all(pc.all(column).as_py() for column in alike):
        return None
    values = {name: table.column(f"{2 * i + 1}") for i, name in enumerate(names) if name in ATTRIBUTES}
    # an XML parser turns tabs into blanks, and refuses other control characters
    texts = [values[name] for name in ("id", "type", "vehicle") if name in values]
    if any(pc.any(pc.match_substring_regex(column, "[[:cntrl:]]")).as_py() for column in texts):
        return None
    return {"time": times, **values}


def _is_valid_utf8_head(head: bytes) -> bool:
    """Return whether the text up to the root element's tag is valid, and its encoding does not change how lines are read."""
    try:
        root = safe_xml.parse(head + b"</fcd-export>", "", TraceError)
    except TraceError:
        return False
    return (root.getroottree().docinfo.encoding or "UTF-8").upper() in {"UTF-8", "US-ASCII"}


def _times_of_vehicles(other_lines: list[tuple[int, str]], n: int) -> pa.Array | None:
    """Return the times of `n` vehicles, each the time of its step; None if the other lines are not only tags of steps.

    `other_lines`: number and text of each line without a vehicle. Errors: `pa.ArrowInvalid` for an invalid time.
    """
    stamps, counts = [""], [0]
    order, above = "", 0
    for number, line in other_lines:
        counts[-1] += number - above - 1
        order += "v" if number > above + 1 else ""
        above = number
        if step := _STEP_TAG.fullmatch(line):
            order += "empty " if step[2] else "begin "
            stamps += [step[1]]
            counts += [0]
        else:
            order += {"</timestep>": "end ", "</fcd-export>": "last"}.get(line, "first " if order == "" else "?")
    if not re.fullmatch("first (empty |begin v*end )*last", order) or sum(counts) < n:
        return None
    return seconds_of_texts(pa.array(stamps[1:], pa.string())).take(np.repeat(np.arange(len(stamps) - 1), counts[1:]))


def parse_columns_and_kinds(path: Path, content: bytes) -> tuple[dict[str, pa.ChunkedArray | pa.Array], np.ndarray]:
    """Return the columns, and for each row the index of its element in `KINDS`."""
    root = safe_xml.parse(content, str(path), TraceError)
    columns: dict[str, list[Any]] = {"time": [], **{name: [] for name in ATTRIBUTES}}
    kind = []
    for step in root.iter("timestep"):
        for item in step:
            if item.tag not in KINDS:
                continue
            kind.append(KINDS.index(item.tag))
            columns["time"].append(step.get("time"))
            for name in ATTRIBUTES:
                columns[name].append(item.get(name))
    return {name: pa.array(values, pa.string()) for name, values in columns.items()}, np.array(kind, np.int8)
