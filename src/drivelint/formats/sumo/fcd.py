"""SUMO's floating car data (`--fcd-output`, XML, CSV or Parquet), with the vehicle types of its route files.

A position is the middle of the front bumper, an angle runs clockwise from north. FCD has no sizes: they stand in the
`vType` elements of a route or additional file, given with --mapping or lying beside the log; states of lights see `sumo_lights`.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv

from drivelint.drive.lost_time import times_of_lost_rows
from drivelint.drive.trace import ACTOR_CLASSES, BRAKE_LIGHTS, INDICATORS, LostTime, QualityFinding, Recording, States
from drivelint.errors import TraceError, UsageError
from drivelint.formats import safe_xml
from drivelint.formats.sumo.end_tag import with_end_tag
from drivelint.formats.sumo.lights import add_light_states
from drivelint.formats.tables import parquet
from drivelint.phrases import listed

if TYPE_CHECKING:
    from drivelint.arrays import Codes, Floats, Mask
    from drivelint.formats.probe import Probe


formats: Final = {"sumo-fcd": ("SUMO floating car data", "said with --ego")}
takes_mapping: Final = True
HEAD_BYTES = 65536
_COLUMNS = ("timestep_time", "vehicle_id", "vehicle_x", "vehicle_y", "vehicle_angle")
_FIELDS = ("id", "x", "y", "angle", "type", "speed", "signals", "acceleration")
_BESIDE = ("*.rou.xml", "*.add.xml", "*vtype*.xml")


class VehicleType(NamedTuple):
    """What a vType says: our class, length and width in metres; NaN: not known."""

    actor_class: str | None = None
    length_m: float = math.nan
    width_m: float = math.nan


_OF_CLASS = {
    **dict.fromkeys(("passenger", "private", "taxi", "evehicle", "hov"), VehicleType("car", 5.0, 1.8)),
    "vip": VehicleType("car"), "delivery": VehicleType("van", 6.5, 2.16), "emergency": VehicleType("vehicle", 6.5, 2.16),
    "truck": VehicleType("truck", 7.1, 2.4), "trailer": VehicleType("truck", 16.5, 2.55), "bus": VehicleType("bus", 12.0, 2.5),
    "coach": VehicleType("bus", 14.0, 2.6), "motorcycle": VehicleType("motorcycle", 2.2, 0.9),
    "moped": VehicleType("motorcycle", 2.1, 0.8), "bicycle": VehicleType("bicycle", 1.6, 0.65), "scooter": VehicleType("bicycle"),
    "pedestrian": VehicleType("pedestrian", 0.215, 0.478), "wheelchair": VehicleType("pedestrian"),
}  # fmt: skip
"""SUMO's own sizes by vClass, where a vType says none (sumo.dlr.de, Vehicle Type Parameter Defaults)."""
_DEFAULTS = {
    "DEFAULT_VEHTYPE": _OF_CLASS["passenger"], "DEFAULT_PEDTYPE": _OF_CLASS["pedestrian"],
    "DEFAULT_BIKETYPE": _OF_CLASS["bicycle"], "DEFAULT_TAXITYPE": _OF_CLASS["taxi"],
}  # fmt: skip
_LONGEST_S = 9e9  # beyond it nanoseconds do not fit into 64 bits
_RIGHT, _LEFT, _EMERGENCY, _BRAKE = 1, 2, 4, 8
_END: Final = "</fcd-export>"
_WHOLE_STEP: Final = r"</timestep>|<timestep\s[^<>]*/>"
_STEP = re.compile(r'<timestep +time="([^"]*)" *(/?)>')


def is_fcd(path: Path, head: bytes) -> bool:
    """Say whether a file is FCD: an <fcd-export> element, or a table with its columns."""
    if head.startswith(b"PAR1"):
        return set(_COLUMNS) <= set(parquet.schema(path).names)
    if _is_csv(head):
        names = re.split(r"[;,\t]", head.split(b"\n", 1)[0].decode("utf-8-sig", "replace").strip())
        return set(_COLUMNS) <= {name.strip('"') for name in names}
    if b"<fcd-export" in head:
        return True
    if head.lstrip()[:1] != b"<" or b"sumo" not in head.lower():
        return False
    with path.open("rb") as file:  # its comment with the configuration may be long
        return b"<fcd-export" in file.read(HEAD_BYTES)


def accepts(probe: Probe) -> bool:
    """Accept by its element or its columns."""
    return not probe.path.is_dir() and is_fcd(probe.path, probe.head)


def read(probe: Probe) -> Recording:
    """Read a log; its mapping is the file with its vTypes, None: those beside it.

    Errors: `TraceError` for a file that cannot be understood, `UsageError` for a types file that has no vType.
    """
    path = probe.path
    rows, lacks_end = _rows(path)
    table = _typed(path, rows)
    nameless = pc.equal(table["id"], "").to_numpy()
    # a step at which nobody is there is a row with its time alone
    filled = np.any([np.isfinite(_floats(table, name)) for name in ("x", "y", "angle", "speed")], axis=0)
    dropped = int((nameless & filled).sum())
    lost = _lost(_floats(table, "time"), nameless & filled, f"{path.name}: rows without an id")
    table = table.filter(pa.array(~nameless)) if nameless.any() else table
    if not table.num_rows:
        raise TraceError(f"{path}: no vehicle in this log")
    untimed = int((~(np.abs(_floats(table, "time")) < _LONGEST_S)).sum())
    if untimed:
        raise TraceError(f"{path}: rows of vehicles without a time that can be: {untimed}: write the log anew")
    types, notes = _types(path, probe.options.mapping)
    recording = _recording(table, types)
    recording.notes += notes
    if lacks_end:
        last_ns = int(recording.states.t_ns.max())
        recording.lost.append(LostTime(last_ns, None, f"{path.name} ends without {_END}: its writer did not finish it"))
    add_light_states(recording, path, _is_log)
    if dropped:
        message = f"rows without an id: {dropped}: they are not judged"
        recording.findings.append(QualityFinding("dropped_row", "error", message, dropped))
        recording.lost += lost
    return recording


def _lost(time_s: Floats, lost: Mask, what: str) -> list[LostTime]:
    timed = np.abs(time_s) < _LONGEST_S
    return times_of_lost_rows(np.round(np.where(timed, time_s, 0.0) * 1e9).astype(np.int64), timed, lost, what)


def _is_log(file: Path) -> bool:
    with file.open("rb") as opened:
        return is_fcd(file, opened.read(HEAD_BYTES))


def _rows(path: Path) -> tuple[pa.Table, bool]:
    """Return the log as a table with the columns of SUMO's CSV, those that it has, and whether the file lacks its end."""
    with path.open("rb") as file:
        start = file.read(16)
    if start.startswith(b"PAR1"):
        return parquet.table(path), False
    if _is_csv(start):
        return _csv(path), False
    content, lacks_end = with_end_tag(path.read_bytes(), "fcd-export", _WHOLE_STEP)
    # where all vehicles look like the first, line by line, else by the parser
    lines = _lines(content)
    return _parsed(path, content) if lines is None else lines, lacks_end


def _is_csv(head: bytes) -> bool:
    """Say whether a file begins with SUMO's first column; other programs that wrote it anew may quote it."""
    return head.lstrip(b'\xef\xbb\xbf"').startswith(b"timestep_t")


def _recording(table: pa.Table, types: dict[str, VehicleType]) -> Recording:
    ids, kinds = (pc.dictionary_encode(table[name]).combine_chunks() for name in ("id", "type"))
    said = [types.get(name) or _DEFAULTS.get(name, VehicleType()) for name in kinds.dictionary.to_pylist()]
    code = kinds.indices.to_numpy()
    length, width = (np.array([getattr(t, side) for t in said], np.float64)[code] for side in ("length_m", "width_m"))
    yaw = np.pi / 2 - np.radians(_floats(table, "angle"))
    yaw = np.arctan2(np.sin(yaw), np.cos(yaw))
    cos, sin = np.cos(yaw), np.sin(yaw)
    speed, accel = _floats(table, "speed"), _floats(table, "acceleration")
    half = np.nan_to_num(length) / 2  # of unknown length: the bumper, and the length stays unknown
    numbers = {
        "x_m": _floats(table, "x") - half * cos, "y_m": _floats(table, "y") - half * sin, "yaw_rad": yaw,
        "vx_mps": speed * cos, "vy_mps": speed * sin, "ax_mps2": accel * cos, "ay_mps2": accel * sin,
        "length_m": length, "width_m": width,
    }  # fmt: skip
    classes = [-1 if t.actor_class is None else ACTOR_CLASSES.index(t.actor_class) for t in said]
    signals = _floats(table, "signals")
    states = States(
        [str(i) for i in ids.dictionary.to_pylist()],
        ids.indices.to_numpy().astype(np.int32),
        np.round(_floats(table, "time") * 1e9).astype(np.int64),
        numbers,
        {"actor_class": np.array(classes, np.int8)[code], **_lights(signals)},
        np.any([pc.is_inf(c).to_numpy() for c in table.columns if pa.types.is_floating(c.type)], axis=0),
    )
    recording = Recording("sumo-fcd", states)
    unknown = sorted({name for name, t in zip(kinds.dictionary.to_pylist(), said, strict=True) if np.isnan(t.length_m)})
    if unknown:
        message = (
            f"no size is known of the vehicle types {listed([n or 'without a name' for n in unknown])}: give the route file "
            "with their vType elements with --mapping; until then their positions are those of the front bumper"
        )
        recording.findings.append(QualityFinding("bumper_position", "warning", message, int(np.isnan(length).sum())))
    return recording


def _lights(signals: Floats) -> dict[str, Codes]:
    known = (signals >= 0) & (signals < 2**31)
    bits = np.where(known, signals, 0).astype(np.int64)
    indicator = np.full(len(bits), INDICATORS.index("off"), np.int8)
    for bit, word in ((_RIGHT, "right"), (_LEFT, "left"), (_EMERGENCY, "hazard")):
        indicator[bits & bit > 0] = INDICATORS.index(word)
    indicator[(bits & _RIGHT > 0) & (bits & _LEFT > 0)] = INDICATORS.index("hazard")
    brake = np.where(bits & _BRAKE > 0, BRAKE_LIGHTS.index("on"), BRAKE_LIGHTS.index("off")).astype(np.int8)
    return {"indicator": np.where(known, indicator, np.int8(-1)), "brake_light": np.where(known, brake, np.int8(-1))}


def _types(path: Path, types_file: str | None) -> tuple[dict[str, VehicleType], list[str]]:
    """Return vType id -> what it says, and a note on where from."""
    if types_file is not None:
        file = Path(types_file)
        found = _read_types(file)
        if not found:
            raise UsageError(
                f"--mapping {types_file}: has no vType: give the route or additional file of the simulation"
            )
        return found, []
    types: dict[str, VehicleType] = {}
    used = []
    for file in sorted({file for pattern in _BESIDE for file in path.parent.glob(pattern)}):
        if found := _read_types(file):
            types |= found
            used.append(file.name)
    return types, [
        f"{path.name}: sizes of vehicles are those of the vTypes in {listed(used)} beside it"
    ] if used else []


def _read_types(file: Path) -> dict[str, VehicleType]:
    try:
        content = file.read_bytes()
    except OSError as error:
        raise UsageError(f"--mapping {file}: cannot be read: {error.strerror or error}") from error
    root = safe_xml.parse(content, f"--mapping {file}:", UsageError)
    found = {}
    for element in root.iter("vType"):
        default = _OF_CLASS.get(element.get("vClass", "passenger"), VehicleType("vehicle"))
        found[element.get("id", "")] = VehicleType(
            default.actor_class,
            _positive(element.get("length"), default.length_m),
            _positive(element.get("width"), default.width_m),
        )
    return found


def _positive(text: str | None, default: float) -> float:
    value = default if text is None else safe_xml.number(text)
    return value if value > 0 else float("nan")


def _floats(table: pa.Table, name: str) -> Floats:
    """Return a column of `_typed` as numbers, NaN where it is absent, empty or infinite."""
    values = np.asarray(table[name].to_numpy(), np.float64)
    return np.where(np.isinf(values), np.nan, values)


def _typed(path: Path, table: pa.Table) -> pa.Table:
    """Return the columns that are read as texts and numbers, "" and NaN where one is empty or not there. Errors: `TraceError`."""
    made = {}
    for name in ("time", *_FIELDS):
        source = "timestep_time" if name == "time" else f"vehicle_{name}"
        try:
            column = table[source] if source in table.schema.names else pa.nulls(len(table))
            if name in {"id", "type"}:
                column = pc.fill_null(column.cast(pa.string()), "")
            else:
                if pa.types.is_string(column.type) or pa.types.is_binary(column.type):
                    column = column.cast(pa.string())
                    column = pc.if_else(pc.equal(column, ""), pa.scalar(None, pa.string()), column)
                column = pc.fill_null(column.cast(pa.float64()), math.nan)
        except (pa.ArrowException, KeyError) as error:
            raise TraceError(
                f"{path}: {name} of vehicles: {' '.join(str(error).split())}: write the log anew"
            ) from error
        made[name] = column
    return pa.table(made)


def _csv(path: Path) -> pa.Table:
    with path.open("rb") as file:
        first = file.readline()
    delimiter = max(";,\t", key=lambda d: first.count(d.encode()))
    try:
        return pa_csv.read_csv(
            path,
            parse_options=pa_csv.ParseOptions(delimiter=delimiter),
            convert_options=pa_csv.ConvertOptions(
                column_types={"vehicle_id": pa.string(), "vehicle_type": pa.string()}
            ),
        )
    except pa.ArrowInvalid as error:
        raise TraceError(f"{path}: {' '.join(str(error).split())}") from error


def _lines(content: bytes) -> pa.Table | None:
    """Read a log with one element per line as CSV with the quotation mark as separator; None if any line looks different."""
    begin = content.find(b"<fcd-export")
    first = re.search(rb'^[ \t]*<vehicle(?: +[\w:.-]+="[^"<\n]*")+ */>(?=\r?$)', content[begin:], re.MULTILINE)
    if first is None or b"&" in content or not _is_plain(content[: content.find(b">", begin) + 1]):
        return None
    parts = first[0].decode("utf-8", "replace").split('"')
    names = [part.split()[-1].removesuffix("=") for part in parts[:-1:2]]
    if len(set(names)) < len(names):
        return None
    columns = [f"{i}" for i in range(len(parts))]
    others: list[tuple[int, str]] = []

    def other(row: Any) -> str:
        others.append((row.number, row.text.strip()))
        return "skip"

    wanted = [c for i, c in enumerate(columns) if i % 2 == 0 or names[i // 2] in _FIELDS]
    try:
        table = pa_csv.read_csv(
            pa.BufferReader(memoryview(content)[begin:]),
            # one thread: the numbers of lines are only known then
            pa_csv.ReadOptions(column_names=columns, use_threads=False, block_size=1 << 24),
            pa_csv.ParseOptions(delimiter='"', quote_char=False, ignore_empty_lines=False, invalid_row_handler=other),
            pa_csv.ConvertOptions(
                column_types=dict.fromkeys(wanted, pa.string()), include_columns=wanted, strings_can_be_null=False
            ),
        )
        times = _times(others, len(table))
    except pa.ArrowInvalid:
        return None
    alike = (pc.equal(table.column(column), part) for column, part in zip(columns[::2], parts[::2], strict=True))
    more = content.count(b"<", begin) > len(table) + len(others)  # elements than lines
    if times is None or more or not all(pc.all(column).as_py() for column in alike):
        return None
    values = {f"vehicle_{name}": table.column(f"{2 * i + 1}") for i, name in enumerate(names) if name in _FIELDS}
    # the parser makes blanks of tabs, and refuses other control characters
    texts = [values[name] for name in ("vehicle_id", "vehicle_type") if name in values]
    if any(pc.any(pc.match_substring_regex(column, "[[:cntrl:]]")).as_py() for column in texts):
        return None
    return pa.table({"timestep_time": times, **values})


def _is_plain(head: bytes) -> bool:
    """Say whether what stands before the first step, the tag of its element included, changes nothing in the lines that follow."""
    try:
        root = safe_xml.parse(head + b"</fcd-export>", "", TraceError)
    except TraceError:
        return False
    return (root.getroottree().docinfo.encoding or "UTF-8").upper() in {"UTF-8", "US-ASCII"}


def _times(others: list[tuple[int, str]], n: int) -> pa.Array | None:
    """Return the times of `n` vehicles, that of the step around each; None where the other lines are not those of steps alone.

    `others`: number and text of each line that is no vehicle's. Errors: `pa.ArrowInvalid` for a time that is no number.
    """
    stamps, counts = [""], [0]
    order, above = "", 0
    for number, line in others:
        counts[-1] += number - above - 1
        order += "v" if number > above + 1 else ""
        above = number
        if step := _STEP.fullmatch(line):
            order += "empty " if step[2] else "begin "
            stamps += [step[1]]
            counts += [0]
        else:
            order += {"</timestep>": "end ", "</fcd-export>": "last"}.get(line, "first " if order == "" else "?")
    if not re.fullmatch("first (empty |begin v*end )*last", order) or sum(counts) < n:
        return None
    return pa.array(stamps[1:], pa.string()).cast(pa.float64()).take(np.repeat(np.arange(len(stamps) - 1), counts[1:]))


def _parsed(path: Path, content: bytes) -> pa.Table:
    root = safe_xml.parse(content, str(path), TraceError)
    rows: dict[str, list[Any]] = {"timestep_time": [], **{f"vehicle_{name}": [] for name in _FIELDS}}
    for step in root.iter("timestep"):
        for item in step:
            if item.tag not in {"vehicle", "person", "container"}:
                continue
            rows["timestep_time"].append(step.get("time"))
            for name in _FIELDS:
                rows[f"vehicle_{name}"].append(item.get(name))
    return pa.table({name: pa.array(values, pa.string()) for name, values in rows.items()})
