"""Reads attributes of XML elements, and refuses numbers that are not finite."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lxml import etree


class MalformedError(ValueError):
    """Raised for an invalid element; the caller adds the id of the road or lane."""


MAX_NUMBER = 1e9  # no length, coordinate or coefficient of a road is larger; beyond it arithmetic loses the millimetres


def number_attribute(element: etree._Element, name: str, default: float | None = None) -> float:
    """Return an attribute as a finite number, or the default if it is absent."""
    if default is not None and name not in element.attrib:
        return default
    text = required_attribute(element, name)
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise MalformedError(f"{_attribute_place(element, name)} is not a finite number")
    if abs(value) > MAX_NUMBER:
        raise MalformedError(f"{_attribute_place(element, name)} is larger than any value on a road")
    return value


def integer_attribute(element: etree._Element, name: str) -> int:
    """Return an attribute as an integer."""
    value = number_attribute(element, name)
    if value != int(value):
        raise MalformedError(f"{_attribute_place(element, name)} is not an integer")
    return int(value)


def required_attribute(element: etree._Element, name: str) -> str:
    """Return an attribute. Errors: `MalformedError` if it is missing."""
    value = element.get(name)
    if value is None:
        raise MalformedError(f"<{element.tag}> in line {element.sourceline} has no attribute {name}")
    return value


def _attribute_place(element: etree._Element, name: str) -> str:
    text = (element.get(name) or "")[:40]
    return f"<{element.tag}> in line {element.sourceline}: {name}={text!r}"
