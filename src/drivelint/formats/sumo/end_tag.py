"""Completes files of SUMO that lack the end tag of their root element, because SUMO was killed between two steps."""

from __future__ import annotations

import re
from typing import Final

_TAIL_BYTES: Final = 4096


def with_end_tag(content: bytes, root: str, step_end_pattern: str) -> tuple[bytes, bool]:
    """Return a file with the end tag of its root element, and whether it was missing.

    `step_end_pattern`: the end of a complete step. A file that ends within a step is returned unchanged: it is not well-formed.
    """
    if re.search(rf"(?:{step_end_pattern})\s*\Z".encode(), content[-_TAIL_BYTES:]) is None:
        return content, False
    return content.rstrip() + f"\n</{root}>\n".encode(), True
