"""Finds topics for which an MCAP log declares a channel, but contains no message."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.formats.mcap.storage import file_index, recorded_file
from drivelint.phrases import name_list

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path


def silent_topics_text(files: Iterable[Path], is_wanted: Callable[[str], bool]) -> str:
    """Return a clause that names the topics of wanted schemas without a message; '' if there are no such topics.

    This reads the whole files again, for the error that nothing usable was found.
    """
    announced: set[str] = set()
    spoken: set[str] = set()
    lossy = False
    for file in files:
        container = recorded_file(file)
        spoken |= {log_message.channel.topic for log_message in container.messages()}
        lossy |= bool(container.losses)
        for part in (container, file_index(file)):
            schemas = part.schemas
            announced |= {
                channel.topic
                for channel in part.channels.values()
                if channel.schema_id in schemas and is_wanted(schemas[channel.schema_id].name)
            }
    silent = sorted(announced - spoken)
    if not silent:
        return ""
    left = " that is left" if lossy else ""
    return (
        f"topic {silent[0]!r} has no message{left}"
        if len(silent) == 1
        else f"{name_list(silent)} have no message{left}"
    )
