"""Times in SUMO's outputs: seconds or, with `--human-readable-time`, H:M:S, and from one day on D:H:M:S."""

from __future__ import annotations

import math
import re
from typing import Final

import pyarrow as pa
import pyarrow.compute as pc

from drivelint.formats import safe_xml

_CLOCK_PATTERN: Final = re.compile(r"(?:(\d+):)?(\d+):([0-5]?\d):([0-5]?\d(?:\.\d+)?)")


def seconds(text: str | None) -> float:
    """Return a time in seconds, NaN if the text is not a time."""
    parts = _CLOCK_PATTERN.fullmatch(text or "")
    if parts is None:
        return safe_xml.number_or_nan(text)
    days, hours, minutes, rest = parts.groups()
    return ((int(days or 0) * 24 + int(hours)) * 60 + int(minutes)) * 60 + float(rest)


def seconds_of_texts(texts: pa.Array | pa.ChunkedArray) -> pa.Array:
    """Return a column of times in seconds; NULL stays NULL. Errors: `pa.ArrowInvalid` for a text that is not a time."""
    try:
        return texts.cast(pa.float64())
    except pa.ArrowInvalid:
        pass
    # all rows of a step have the same time: each distinct time is converted once
    times = pc.dictionary_encode(texts.combine_chunks() if isinstance(texts, pa.ChunkedArray) else texts)
    is_clock = pc.match_substring(times.dictionary, ":")
    clocks = pa.array(map(_seconds_of_clock, times.dictionary.filter(is_clock).to_pylist()), pa.float64())
    numbers = pc.if_else(is_clock, pa.scalar(None, pa.string()), times.dictionary).cast(pa.float64())
    return pc.replace_with_mask(numbers, is_clock, clocks).take(times.indices)


def _seconds_of_clock(text: str) -> float:
    clock_s = seconds(text)
    if math.isnan(clock_s):
        raise pa.ArrowInvalid(f"{text!r} is neither seconds nor a clock, [D:]H:M:S")
    return clock_s
