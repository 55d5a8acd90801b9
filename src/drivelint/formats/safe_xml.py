"""Parses XML as untrusted input: no entities, no network, no DTD, bounded depth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from lxml import etree

from drivelint.errors import MapError

if TYPE_CHECKING:
    from drivelint.errors import DriveLintError
    from drivelint.road.map_reader import MapSource


def parse(content: bytes, name: str, error_class: type[DriveLintError]) -> etree._Element:
    """Return the root element; tags have no namespaces. Errors: `error_class`, about `name`, if it is not well-formed or has a DOCTYPE."""
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )
    doctype = error_class(f"{name} contains a DOCTYPE, which is refused, because no map or log needs it: remove it")
    try:
        root = etree.fromstring(content, parser)
    except etree.XMLSyntaxError as error:
        if b"<!DOCTYPE" in content[:65536]:
            raise doctype from None
        raise error_class(f"{name} is not well-formed XML ({error.msg}): give the complete, unchanged file") from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise doctype
    if b"xmlns" not in content and content[:2] not in {b"\xff\xfe", b"\xfe\xff"}:
        return root  # no namespace is declared
    for element in root.iter():
        if isinstance(element.tag, str) and element.tag.startswith("{"):
            element.tag = element.tag.partition("}")[2]
    return root


def parse_map(source: MapSource) -> etree._Element:
    """Return the root element of a map; tags have no namespaces. Errors: `MapError`."""
    return parse(source.content, f"map {source.name}", MapError)


def number_or_nan(text: str | None) -> float:
    """Return a text as a number, NaN if it is not a number."""
    try:
        return float(text or "nan")
    except ValueError:
        return math.nan
