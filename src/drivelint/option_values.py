"""Reads option values that are more than a word or a number, for the command line and for Python."""

from __future__ import annotations

import os
import re
from datetime import UTC, date, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from drivelint.errors import UsageError

if TYPE_CHECKING:
    from drivelint.drive.trace import EgoSize
    from drivelint.pack import PackRequest


def parse_today(day: date | str | None) -> date:
    """Return the date that decides whether a waiver has expired; without one, the system's date. Errors: `UsageError`."""
    if day is None:
        return datetime.now().astimezone().date()
    text = day.isoformat() if isinstance(day, date) else day
    try:
        return date.fromisoformat(text)
    except ValueError as error:
        raise UsageError(f"--today {text!r}: write a day such as 2027-03-31") from error


def parse_memory(text: str | None) -> int | None:
    """Read the database's memory limit in bytes, None for `none`; without a text, the default. Errors: `UsageError`."""
    from drivelint.engine.memory import DEFAULT_MEMORY_BYTES, LEAST_MEMORY_BYTES

    if text is None:
        return DEFAULT_MEMORY_BYTES
    if text.strip().lower() == "none":
        return None
    match = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*([KMGT])(i?)B\s*", text, re.IGNORECASE)
    if match is None:
        raise UsageError(f"--memory {text!r}: write a size such as 512MB or 1.5GB, or none")
    number, prefix, binary = match.groups()
    size = int(float(number) * (1024 if binary else 1000) ** ("KMGT".index(prefix.upper()) + 1))
    if size < LEAST_MEMORY_BYTES:
        raise UsageError(f"--memory {text}: the least is {LEAST_MEMORY_BYTES // 10**6}MB")
    return size


def folder_of_argument_or_option(argument: Path | None, option: Path | None, default: Path) -> Path:
    """Return the folder that an argument or `--out` names. Errors: `UsageError` if they name different folders."""
    if argument is not None and option not in {None, argument}:
        raise UsageError(f"{argument} and --out {option}: name one folder")
    return argument or option or default


def robustness_option_with_confidence(confidence: float | None, robustness: bool | None) -> bool | None:
    """Return the option `robustness`; True if a confidence is given, which needs the copies of all findings.

    Errors: `UsageError` for a confidence that is not from 0 to 1, or that is combined with no copies.
    """
    if confidence is not None and robustness is False:
        raise UsageError("--confidence needs the copies that --no-robustness leaves out: use one of them")
    if confidence is not None and not 0 <= confidence <= 1:
        raise UsageError(f"--confidence {confidence}: write a share from 0 to 1, such as 0.95")
    return robustness if confidence is None else True


def parse_number_or_all(option: str, text: str) -> int | None:
    """Read a count, None for `all`. Errors: `UsageError`."""
    if text.strip().lower() == "all":
        return None
    if not re.fullmatch(r"\s*\d{1,9}\s*", text, re.ASCII):
        raise UsageError(f"{option} {text!r}: write a number such as 100, or all")
    return int(text)


def parse_shard(text: str | None) -> tuple[int, int] | None:
    """Read I/N, the I-th of N parts. Errors: `UsageError`."""
    if text is None:
        return None
    match = re.fullmatch(r"(\d+)/(\d+)", text.strip())
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise UsageError(f"--shard {text!r}: write which of how many parts, such as 1/3")
    return int(match[1]), int(match[2])


def _comma_separated_numbers(text: str) -> tuple[float, ...]:
    """Return the comma-separated numbers; an empty tuple if one of them is not a number."""
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError:
        return ()


def parse_offset(text: str | None) -> tuple[float, float] | None:
    """Read DX,DY in metres. Errors: `UsageError`."""
    if text is None:
        return None
    match _comma_separated_numbers(text):
        case dx, dy:
            return dx, dy
    raise UsageError(f"--map-offset {text!r}: write two numbers in metres, DX,DY, such as 2.6,3.1")


def parse_ego_size(text: str | None) -> EgoSize | None:
    """Read L,W[,AHEAD] in metres. Errors: `UsageError`."""
    if text is None:
        return None
    from drivelint.drive.trace import EgoSize

    size = _comma_separated_numbers(text)
    if len(size) in {2, 3} and 0.0 < size[0] < 100.0 and 0.0 < size[1] < 10.0 and all(abs(x) < 100.0 for x in size[2:]):
        return EgoSize(*size)
    raise UsageError(f"--ego-size {text!r}: write length and width in metres, such as 4.9,1.9 or 4.9,1.9,1.4")


def parse_origin(text: str | None) -> tuple[float, float] | None:
    """Read LAT,LON in degrees. Errors: `UsageError`."""
    if text is None:
        return None
    match _comma_separated_numbers(text):
        case lat, lon if abs(lat) <= 90 and abs(lon) <= 180:
            return lat, lon
    raise UsageError(f"--map-origin {text!r}: write latitude and longitude in degrees, LAT,LON, such as 51.5,-2.58")


def pack_request(
    evidence: Path | None,
    sign: Path | None,
    result: str | Path | None,
    *,
    has_all_drives: bool = True,
    overwrite: bool = False,
) -> PackRequest | None:
    """Return the request for an evidence pack of the result that `check` or `audit` will write; None: no pack is requested.

    `has_all_drives`: the command judges all drives and packs their results. Errors: `UsageError` for mistakes that can be found before
    judging.
    """
    if evidence is None:
        if sign is not None:
            raise UsageError("--sign is for an evidence pack: name its folder with --evidence PACK")
        return None
    if result is None:
        raise UsageError("--evidence packs what --out writes: use --out, too")
    if not has_all_drives:
        raise UsageError(
            "--evidence packs a whole audit: when all parts have ended, run drivelint merge and then drivelint pack"
        )
    from drivelint.pack import PackRequest, signing_key_of_valid_request

    request = PackRequest(Path(result), evidence, sign, date=parse_pack_date(None), overwrite=overwrite)
    signing_key_of_valid_request(request)
    return request


def parse_pack_date(day: str | None) -> str | None:
    """Return the date of the pack: the given day, else that of SOURCE_DATE_EPOCH; None: both are missing. Errors: `UsageError`."""
    if day is not None:
        return parse_day("--date", day)
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        return None if epoch is None else datetime.fromtimestamp(int(epoch), UTC).date().isoformat()
    except (ValueError, OverflowError, OSError) as error:
        raise UsageError(
            f"SOURCE_DATE_EPOCH={epoch} is not a valid time: give the seconds since 1970-01-01 as a whole number"
        ) from error


def parse_day(option: str, day: str) -> str:
    """Return the day, in ISO format, that an option gives. Errors: `UsageError`."""
    try:
        return datetime.strptime(day, "%Y-%m-%d").replace(tzinfo=UTC).date().isoformat()
    except ValueError as error:
        raise UsageError(f"{option} {day} is not a valid date: write it as 2026-11-26") from error
