"""XML that may hold a log's own words, in which XML does not allow every character."""

from __future__ import annotations

import re
from typing import Final

from lxml import etree

from drivelint.phrases import escape_invisible

_NOT_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def replace_non_xml(text: str) -> str:
    """Return text of a log without characters that XML forbids, and with invisible ones shown as codes."""
    return escape_invisible(_NOT_XML.sub("\ufffd", text))


def add(parent: etree._Element, tag: str, **attributes: str) -> etree._Element:
    """Append an element with these attributes, in their order, and return it."""
    return etree.SubElement(parent, tag, {name: replace_non_xml(value) for name, value in attributes.items()})


def document(root: etree._Element) -> bytes:
    """Return a document as UTF-8, indented."""
    return bytes(etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True))
