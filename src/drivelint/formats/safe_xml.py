"""XML as untrusted input: no entities, no network, no DTD, bounded depth."""

from __future__ import annotations

from lxml import etree


class RefusedError(ValueError):
    """The content is not well-formed XML, or carries a DOCTYPE; the message says which and goes on from a file's name."""


def parse(content: bytes) -> etree._Element:
    """Return the root element, tags without namespaces. Errors: `RefusedError`."""
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )
    doctype = "carries a DOCTYPE, which no map or log needs and which is refused: remove it"
    try:
        root = etree.fromstring(content, parser)
    except etree.XMLSyntaxError as error:
        if b"<!DOCTYPE" in content[:65536]:
            raise RefusedError(doctype) from None
        raise RefusedError(f"is not well-formed XML ({error.msg}): give the complete, unchanged file") from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise RefusedError(doctype)
    if b"xmlns" not in content and content[:2] not in {b"\xff\xfe", b"\xfe\xff"}:
        return root  # without a declaration nothing has a namespace
    for element in root.iter():
        if isinstance(element.tag, str) and element.tag.startswith("{"):
            element.tag = element.tag.partition("}")[2]
    return root
