"""The categories of annotated objects in Argoverse 2, and their actor classes.

Source: the taxonomies of the sensor and the motion forecasting dataset (Argoverse user guide; av2-api, `AnnotationCategories` and
`ObjectType`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from drivelint.arrays import codes_of_texts
from drivelint.drive.trace import ACTOR_CLASSES
from drivelint.phrases import name_list

if TYPE_CHECKING:
    import pyarrow as pa

    from drivelint.arrays import Codes

EGO_CATEGORY: Final = "EGO_VEHICLE"
"""Not a category of Argoverse: some tools use it for a box of the recording vehicle itself, centred on the rear axle."""
SENSOR_CLASSES: Final = {
    "REGULAR_VEHICLE": "car",  # a passenger car, van, pickup or SUV: no rule distinguishes these
    "LARGE_VEHICLE": "vehicle",  # without a category of its own: a camper van, a fire engine, ...
    "TRUCK": "truck", "BOX_TRUCK": "truck", "TRUCK_CAB": "truck",
    "BUS": "bus", "SCHOOL_BUS": "bus", "ARTICULATED_BUS": "bus",
    "MOTORCYCLE": "motorcycle", "RAILED_VEHICLE": "vehicle",
    "VEHICULAR_TRAILER": "trailer", "MESSAGE_BOARD_TRAILER": "trailer", "TRAFFIC_LIGHT_TRAILER": "trailer",
    "BICYCLIST": "bicycle", "MOTORCYCLIST": "motorcycle",
    "WHEELED_RIDER": None,  # on a kick scooter, a skateboard, a golf cart, ...: several classes in law
    "PEDESTRIAN": "pedestrian", "OFFICIAL_SIGNALER": "pedestrian",
    "DOG": "animal", "ANIMAL": "animal",
    # ridden or pushed things: their users have boxes of their own. One that moves may still be any road user, see road_user.sql
    "BICYCLE": "object", "WHEELED_DEVICE": "object", "WHEELCHAIR": "object", "STROLLER": "object",
    "BOLLARD": "object", "CONSTRUCTION_CONE": "object", "CONSTRUCTION_BARREL": "object", "SIGN": "object", "STOP_SIGN": "object",
    "MOBILE_PEDESTRIAN_CROSSING_SIGN": "object", "MOBILE_PEDESTRIAN_SIGN": "object",
    EGO_CATEGORY: "car",
}  # fmt: skip
"""Category of an annotation -> actor class; None: any class is possible."""
FORECASTING_CLASSES: Final = {
    "vehicle": "vehicle", "bus": "bus", "motorcyclist": "motorcycle", "cyclist": "bicycle", "pedestrian": "pedestrian",
    "static": "object", "background": "object", "construction": "object", "riderless_bicycle": "object", "unknown": None,
}  # fmt: skip
"""`object_type` of a track -> actor class; None: any class is possible."""
RIDER_CATEGORIES: Final = ("BICYCLIST", "MOTORCYCLIST", "WHEELED_RIDER")
RIDDEN_CATEGORIES: Final = ("BICYCLE", "MOTORCYCLE", "WHEELED_DEVICE", "WHEELCHAIR")


def class_codes(categories: pa.Array, class_by_category: dict[str, str | None]) -> tuple[Codes, list[str]]:
    """Return the index into `ACTOR_CLASSES` of each category (-1: not known), and a note on categories that have no entry, if any."""
    foreign: list[str] = []

    def class_code(category: str) -> int:
        if category not in class_by_category:
            foreign.append(category)
        name = class_by_category.get(category)
        return -1 if name is None else ACTOR_CLASSES.index(name)

    codes = codes_of_texts(categories, class_code)
    note = f"categories that Argoverse does not define, so the class is not known: {name_list(sorted(foreign))}"
    return codes, [note] if foreign else []
