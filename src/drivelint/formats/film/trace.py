"""What was detected in the frames of a film, as a table or as boxes in MCAP, through a mapping of that kind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from drivelint.drive.trace import Recording
    from drivelint.formats.probe import Probe

formats: Final[dict[str, tuple[str, str]]] = {}
takes_mapping: Final = True


def accepts(probe: Probe) -> bool:
    """Accept by the mapping; a table without one by the columns of a shipped one."""
    from drivelint.formats.film import mapping as video_mapping
    from drivelint.formats.film import reader as video

    if probe.path.is_dir():
        return False
    if probe.options.mapping is not None:
        return video_mapping.is_video_mapping(probe.options.mapping)
    return (
        probe.head[:16].lstrip(b"\xef\xbb\xbf").startswith(b"frame") and video.matching_mapping(probe.path) is not None
    )


def read(probe: Probe) -> Recording:
    """Read the detections."""
    from drivelint.formats.film import reader as video

    return video.read(probe.path, probe.options.mapping or video.matching_mapping(probe.path) or "")
