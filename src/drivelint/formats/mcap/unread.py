"""Reports topics whose messages are in an unsupported encoding, so that their content is unknown."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from drivelint.drive.trace import QualityFinding
from drivelint.errors import TraceError

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

    from mcap.records import Channel


@dataclass
class UnreadTopics:
    """Topics whose messages are skipped: topic -> kind, why, and number of its messages."""

    topics: dict[str, tuple[str, str, int]] = field(default_factory=dict)

    def add(self, channel: Channel, kind: str) -> None:
        """Count a message that would be read if its encoding were supported."""
        self._count(channel, kind, f"is in {channel.message_encoding or 'no encoding'!r}, which is not read")

    def add_undefined(self, channel: Channel, kind: str) -> None:
        """Count a message that would be read if its definition were known."""
        self._count(channel, kind, "has no message definitions in the log, and none is known for it")

    def _count(self, channel: Channel, kind: str, why: str) -> None:
        n = self.topics.get(channel.topic, ("", "", 0))[2]
        self.topics[channel.topic] = kind, why, n + 1

    def discard(self, kind: str) -> None:
        """Forget the topics of a kind."""
        self.topics = {topic: facts for topic, facts in self.topics.items() if facts[0] != kind}

    def texts(self) -> list[str]:
        """Return for each topic why it is not read."""
        return [_topic_text(topic, *facts) for topic, facts in sorted(self.topics.items())]

    def findings(self) -> list[QualityFinding]:
        """Return a finding for each topic."""
        return [
            QualityFinding("unread_topic", "error", f"{text}: its content is unknown", facts[2])
            for text, (_, facts) in zip(self.texts(), sorted(self.topics.items()), strict=True)
        ]

    def refuse_kinds(self, path: Path, kinds: Collection[str], read_topics: Collection[str]) -> None:
        """Raise `TraceError` if a skipped topic has messages of these `kinds`, which contain road users: its actors are unknown.

        `read_topics`: topics of these kinds in a supported encoding; the error proposes the first.
        """
        for topic, facts in sorted(self.topics.items()):
            if facts[0] in kinds:
                choice = f", or judge without it: --topic {min(read_topics)}" if read_topics else ""
                raise TraceError(f"{path}: {_topic_text(topic, *facts)}: its actors are unknown: convert it{choice}")


def _topic_text(topic: str, kind: str, why: str, n: int) -> str:
    messages = "1 message" if n == 1 else f"{n} messages"
    return f"topic {topic!r} ({messages} of {kind}) {why}"
