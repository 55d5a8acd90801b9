"""Traffic lights of OSI, bulb by bulb."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.formats.osi import osi_log

if TYPE_CHECKING:
    from pathlib import Path


def write(path: Path, frames: list[Any], **options: Any) -> Path:
    return osi_log.write(path / "drive.mcap", osi_log.truths(frames), **options)


def bulb(truth: Any, number: int, color: int, mode: int, signal: str | None = None) -> None:
    light = truth.traffic_light.add()
    light.id.value = number
    light.classification.color, light.classification.mode = color, mode
    if signal is not None:
        source = light.source_reference.add()
        source.type = "net.asam.opendrive"
        source.identifier.append(signal)
