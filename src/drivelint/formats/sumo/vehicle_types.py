"""The types of SUMO's vehicles and persons (`vType`): class and size, which floating car data do not have."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

from drivelint.errors import UsageError
from drivelint.formats import safe_xml
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

_TYPE_FILE_PATTERNS: Final = ("*.rou.xml", "*.add.xml", "*vtype*.xml")
_COPY_SIGN: Final = "@"


class VehicleType(NamedTuple):
    """The facts about a vType: actor class, length and width in metres; None or NaN: not known."""

    actor_class: str | None = None
    length_m: float = math.nan
    width_m: float = math.nan


_DEFAULT_BY_CLASS: Final = {
    **dict.fromkeys(("passenger", "private", "taxi", "evehicle", "hov", "vip"), VehicleType("car", 5.0, 1.8)),
    **dict.fromkeys(("authority", "army", "custom1", "custom2"), VehicleType("vehicle", 5.0, 1.8)),
    "delivery": VehicleType("van", 6.5, 2.16), "emergency": VehicleType("vehicle", 6.5, 2.16),
    "truck": VehicleType("truck", 7.1, 2.4), "trailer": VehicleType("truck", 16.5, 2.55), "bus": VehicleType("bus", 12.0, 2.5),
    "coach": VehicleType("bus", 14.0, 2.6), "motorcycle": VehicleType("motorcycle", 2.2, 0.9),
    "moped": VehicleType("motorcycle", 2.1, 0.78), "bicycle": VehicleType("bicycle", 1.6, 0.65),
    "scooter": VehicleType("bicycle", 1.2, 0.5), "pedestrian": VehicleType("pedestrian", 0.215, 0.478),
    "wheelchair": VehicleType("pedestrian", 1.2, 0.72), "container": VehicleType("object", 6.096, 2.438),
}  # fmt: skip
"""The default sizes of SUMO 1.28 by vClass, for a vType without sizes. Trains are left out, because they bend."""
_TYPE_BY_DEFAULT_NAME: Final = {
    "DEFAULT_VEHTYPE": _DEFAULT_BY_CLASS["passenger"], "DEFAULT_PEDTYPE": _DEFAULT_BY_CLASS["pedestrian"],
    "DEFAULT_BIKETYPE": _DEFAULT_BY_CLASS["bicycle"], "DEFAULT_TAXITYPE": _DEFAULT_BY_CLASS["taxi"],
    "DEFAULT_CONTAINERTYPE": _DEFAULT_BY_CLASS["container"],
}  # fmt: skip
UNKNOWN_TYPE: Final = VehicleType()


def type_and_original(
    name: str, types: Mapping[str, VehicleType], ids: Collection[str]
) -> tuple[VehicleType, str | None]:
    """Return the facts about a type, and the type of which it is assumed to be a copy.

    If a parameter of a single vehicle is changed while SUMO runs, its type becomes a copy with the name BASE@ID, where ID is one
    of the log's `ids`. No route file contains this type. Source: SUMO's documentation of "TraCI/Change Vehicle State".
    """
    known_type = types.get(name) or _TYPE_BY_DEFAULT_NAME.get(name)
    if known_type is not None:
        return known_type, None
    at = name.find(_COPY_SIGN)
    while at >= 0:
        base = name[:at]
        if name[at + 1 :] in ids and (known_type := types.get(base) or _TYPE_BY_DEFAULT_NAME.get(base)):
            return known_type, base
        at = name.find(_COPY_SIGN, at + 1)
    return UNKNOWN_TYPE, None


def types_and_notes(log: Path, types_file: str | None) -> tuple[dict[str, VehicleType], list[str]]:
    """Return vType id -> its attributes, and notes on their source: `types_file`, the user's file, else the files beside the log.

    Errors: `UsageError` for a given file that has no vType.
    """
    if types_file is not None:
        file_types = _read_types(Path(types_file))
        if not file_types:
            raise UsageError(
                f"--mapping {types_file}: has no vType: give the route or additional file of the simulation"
            )
        return file_types, []
    types: dict[str, VehicleType] = {}
    files: dict[str, str] = {}
    used = []
    notes = []
    for file in sorted({file for pattern in _TYPE_FILE_PATTERNS for file in log.parent.glob(pattern)}):
        here = _read_types(file)
        used += [file.name] if here else []
        for name, vehicle_type in here.items():
            if name in types and types[name] != vehicle_type:
                notes.append(
                    f"{log.name}: the type {name} differs between {file.name} and {files[name]} in the same folder, "
                    "and is treated as unknown: give the file of the simulation with --mapping"
                )
                types[name] = UNKNOWN_TYPE
            else:
                types[name], files[name] = vehicle_type, file.name
    if used:
        notes.insert(0, f"{log.name}: sizes of vehicles are those of the vTypes in {name_list(used)} beside it")
    return types, notes


def _read_types(file: Path) -> dict[str, VehicleType]:
    try:
        content = file.read_bytes()
    except OSError as error:
        raise UsageError(f"--mapping {file}: cannot be read: {error.strerror or error}") from error
    root = safe_xml.parse(content, f"--mapping {file}:", UsageError)
    types = {}
    for element in root.iter("vType"):
        default = _DEFAULT_BY_CLASS.get(element.get("vClass", "passenger"), VehicleType("vehicle"))
        types[element.get("id", "")] = VehicleType(
            default.actor_class,
            _positive_or_nan(element.get("length"), default.length_m),
            _positive_or_nan(element.get("width"), default.width_m),
        )
    return types


def _positive_or_nan(text: str | None, default: float) -> float:
    value = default if text is None else safe_xml.number_or_nan(text)
    return value if value > 0 else math.nan
