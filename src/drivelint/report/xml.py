"""Writes XML with texts from logs, which may contain characters that XML does not allow."""

from __future__ import annotations

import re
from typing import Final

from lxml import etree

from drivelint.phrases import escape_invisible

_NOT_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def replace_non_xml(text: str) -> str:
    """Return a text in which U+FFFD replaces characters that XML forbids, and codes replace invisible characters."""
    return escape_invisible(_NOT_XML.sub("\ufffd", text))


def add_element(parent: etree._Element, tag: str, **attributes: str) -> etree._Element:
    """Append an element with these attributes, in this order, to `parent` and return the element."""
    return etree.SubElement(parent, tag, {name: replace_non_xml(value) for name, value in attributes.items()})


def xml_bytes(root: etree._Element) -> bytes:
    """Return the document with this root as indented UTF-8."""
    return bytes(etree.tostring(root, xml_declaration=True, encoding="UTF-8", pretty_print=True))
