"""Damage to files, drawn from a random generator: bytes that a disk or a cable spoils, text that a person or a program garbles."""

from __future__ import annotations

import re
import struct
from random import Random
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Callable

LENGTHS: Final = (0, 1, -1, 2**31 - 1, 2**31, 2**32 - 1, 2**40, 2**60, 2**63 - 1, 2**63, 2**64 - 1)
"""What a length or a count may be set to."""
NUMBERS: Final = (
    "nan", "inf", "-inf", "1e308", "-1e308", "1e309", "5e-324", "-1", "0", "-0.0", str(2**63), str(2**64), "1e400", "0x10",
    "9" * 40, "1.5.5", "", "\uff11", "true",
)  # fmt: skip
"""What a number in a text may become."""
NESTS: Final = (b"[", b"{", b"(", b"<a>", b'{"a":', b'"', b"'", b"/*", b"[[", b"NOT ", b"-", b"a.")
_NUMBER: Final = re.compile(rb"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_TOKEN: Final = re.compile(rb"[A-Za-z_][\w.-]*|[-+]?\d[\d.eE+-]*|[^\s\w]")
_WORD: Final = re.compile(rb"[A-Za-z_][\w.-]*")
_VALUE: Final = re.compile(rb"""=\s*["']([^"'<>]*)["']""")
_ATTRIBUTE: Final = re.compile(rb"""\s[\w:.-]{1,40}\s*=\s*["'][^"'<>]*["']""")
_ELEMENT: Final = re.compile(
    rb"<\w{1,40}\b[^<>]{0,999}/>|<(\w{1,40})\b[^<>]{0,999}>[^<>]{0,999}</\1>"
)  # bounds: a text may be long
DEEP: Final = 20_000
LONG: Final = 300_000

Mutation = "Callable[[bytes, Random], bytes]"


def generator(seed: object) -> Random:
    """Return a generator that gives the same numbers for the same seed."""
    return Random(str(seed))  # noqa: S311 - cases must be repeatable


def _span(data: bytes, rng: Random, max_length: int) -> tuple[int, int]:
    """Return begin and end of some bytes, at most this many; short runs are as likely as long ones."""
    at = rng.randrange(len(data) + 1)
    return at, min(len(data), at + int(2 ** rng.uniform(0, max(1, max_length).bit_length())))


def flip_bits(data: bytes, rng: Random) -> bytes:
    """Flip one to four bits."""
    changed = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        if changed:
            changed[rng.randrange(len(changed))] ^= 1 << rng.randrange(8)
    return bytes(changed)


def set_byte(data: bytes, rng: Random) -> bytes:
    """Set one byte to any value."""
    at = rng.randrange(len(data) + 1)
    return data[:at] + bytes([rng.randrange(256)]) + data[at + 1 :]


def zero_run(data: bytes, rng: Random) -> bytes:
    """Set a run of bytes to zero, as a file system leaves behind a block that was never written."""
    begin, end = _span(data, rng, len(data))
    return data[:begin] + bytes(end - begin) + data[end:]


def cut_end(data: bytes, rng: Random) -> bytes:
    """Cut the file off."""
    return data[: rng.randrange(len(data) + 1)]


def cut_out(data: bytes, rng: Random) -> bytes:
    """Remove a run of bytes."""
    begin, end = _span(data, rng, len(data) // 2)
    return data[:begin] + data[end:]


def repeat_block(data: bytes, rng: Random) -> bytes:
    """Write a run of bytes twice."""
    begin, end = _span(data, rng, 4096)
    return data[:end] + data[begin:end] + data[end:]


def move_block(data: bytes, rng: Random) -> bytes:
    """Move a run of bytes to another place."""
    begin, end = _span(data, rng, 4096)
    rest = data[:begin] + data[end:]
    at = rng.randrange(len(rest) + 1)
    return rest[:at] + data[begin:end] + rest[at:]


def set_length(data: bytes, rng: Random) -> bytes:
    """Overwrite 4 or 8 bytes by a number that is no length: huge, zero or negative."""
    size = rng.choice((4, 8))
    number = rng.choice(LENGTHS) & (2 ** (8 * size) - 1)
    small = [i for i in range(max(0, len(data) - size)) if data[i + size - 1 : i + size] == b"\0" and data[i]]
    # small numbers, whose upper bytes are zero, are lengths more often than not
    at = rng.choice(small) if small and rng.random() < 0.7 else rng.randrange(len(data) + 1)
    changed: bytes = data[:at] + number.to_bytes(size, "little") + data[at + size :]
    return changed


def set_double(data: bytes, rng: Random) -> bytes:
    """Overwrite 8 bytes by a floating-point number at the edge of what there is."""
    at = rng.randrange(len(data) + 1)
    return data[:at] + struct.pack("<d", rng.choice(EXTREMES)) + data[at + 8 :]


EXTREMES: Final = (float("nan"), float("inf"), float("-inf"), 1e308, -1e308, 5e-324, -1.0, 0.0, 2.0**63, 1e18)

BINARY: Final = (
    flip_bits, flip_bits, set_byte, zero_run, cut_end, cut_out, repeat_block, move_block, set_length, set_length, set_double,
)  # fmt: skip
"""Ways to damage any file."""


def set_number(data: bytes, rng: Random) -> bytes:
    """Replace a number by one at the edge of what there is, or by what is none."""
    return _replaced(data, rng, _NUMBER, lambda _: rng.choice(NUMBERS).encode())


def swap_tokens(data: bytes, rng: Random) -> bytes:
    """Exchange two tokens."""
    found = [match.span() for match in _TOKEN.finditer(data)]
    if len(found) < 2:
        return data
    (a, b), (c, d) = sorted(rng.sample(found, 2))
    return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]


def drop_token(data: bytes, rng: Random) -> bytes:
    """Remove a token."""
    return _replaced(data, rng, _TOKEN, lambda _: b"")


def long_token(data: bytes, rng: Random) -> bytes:
    """Replace a word by one that is very long."""
    return _replaced(data, rng, _WORD, lambda old: (old * (LONG // max(1, len(old)) + 1))[:LONG])


def odd_text(data: bytes, rng: Random) -> bytes:
    """Insert characters that are hard to handle: controls, half of a UTF-8 sequence, a byte order mark, an entity."""
    odd = rng.choice(
        (b"\0", b"\x1b[2J", b"\xff", b"\xc3", "\ufeff".encode(), "\u202e".encode(), b"&#0;", b"&lol;", b"\r", b"\n\n")
    )
    at = rng.randrange(len(data) + 1)
    return data[:at] + odd + data[at:]


def nest(data: bytes, rng: Random) -> bytes:
    """Open brackets many times over at a token."""
    return _replaced(data, rng, _TOKEN, lambda old: rng.choice(NESTS) * rng.choice((30, 300, DEEP)) + old)


def swap_values(data: bytes, rng: Random) -> bytes:
    """Give one attribute or element of XML the value of another."""
    found = [match.span(1) for match in _VALUE.finditer(data)]
    if len(found) < 2:
        return data
    (a, b), (c, d) = rng.sample(found, 2)
    return data[:a] + data[c:d] + data[b:]


def drop_attribute(data: bytes, rng: Random) -> bytes:
    """Remove an attribute of XML."""
    return _replaced(data, rng, _ATTRIBUTE, lambda _: b"")


def drop_element(data: bytes, rng: Random) -> bytes:
    """Remove or repeat an element of XML that has no children."""
    times = rng.choice((0, 0, 2))
    return _replaced(data, rng, _ELEMENT, lambda old: old * times)


def swap_lines(data: bytes, rng: Random) -> bytes:
    """Repeat, drop or exchange a line."""
    lines = data.splitlines(keepends=True)
    if len(lines) < 2:
        return data
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    match rng.randrange(3):
        case 0:
            lines.insert(j, lines[i])
        case 1:
            del lines[i]
        case _:
            lines[i], lines[j] = lines[j], lines[i]
    return b"".join(lines)


def _replaced(data: bytes, rng: Random, pattern: re.Pattern[bytes], new: Callable[[bytes], bytes]) -> bytes:
    found = [match.span() for match in pattern.finditer(data)]
    if not found:
        return data
    begin, end = rng.choice(found)
    return data[:begin] + new(data[begin:end]) + data[end:]


TEXT: Final = (
    set_number, set_number, set_number, swap_tokens, swap_tokens, drop_token, long_token, odd_text, nest, swap_lines, cut_end, cut_out,
    repeat_block, move_block, flip_bits, zero_run,
)  # fmt: skip
"""Ways to damage a text."""


XML: Final = (*TEXT, *(swap_values, drop_attribute, drop_element, set_number) * 6)
"""Ways to damage XML: most of them leave it well-formed, so that what reads it comes to see it."""


def mutated(data: bytes, rng: Random, ways: tuple[Callable[[bytes, Random], bytes], ...]) -> bytes:
    """Damage a file once to three times, once more often than not."""
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        data = rng.choice(ways)(data, rng)
    return data
