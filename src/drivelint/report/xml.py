"""Replaces characters that XML does not allow."""

from __future__ import annotations

import re
from typing import Final

_NOT_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def replace_non_xml(text: str) -> str:
    """Return text with the characters that XML cannot hold replaced: ids and reasons are a log's own words."""
    return _NOT_XML.sub("\ufffd", text)
