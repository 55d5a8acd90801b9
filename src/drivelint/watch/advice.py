"""Finds the profile with which an overtake would still be possible. This is only advice: nothing is controlled from here."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

    from drivelint.watch.judge import JudgedWindow

_REFERENCE = ("rule_id", "ego_id", "object_id", "t_ref_ns")


class ProfileAdvice:
    """The advice of a watch: each occasion is reported once."""

    def __init__(self, style_by_profile: Mapping[str, int]) -> None:
        self._style_by_profile = style_by_profile
        self._told: set[tuple[object, ...]] = set()

    def new_messages(self, window: JudgedWindow, drive_start_ns: int) -> list[dict[str, Any]]:
        """Return a message for each new occasion: the most relaxed profile whose verdict is pass, or none.

        An occasion is a rule, ego, object and reference point, judged by profile. A profile whose verdict is unknown is never the answer.
        """
        occasions: dict[tuple[Any, ...], dict[str, str]] = defaultdict(dict)
        for row in window.verdicts.to_pylist():
            if (
                row["profile"] in self._style_by_profile
                and row["profile"] != "observed"
                and row["t_ref_ns"] is not None
            ):
                occasions[tuple(row[name] for name in _REFERENCE)][row["profile"]] = row["verdict"]
        messages = []
        for key, verdicts in sorted(occasions.items(), key=str):
            if key in self._told or not {"pass", "fail"} & set(verdicts.values()):
                continue
            self._told.add(key)
            order = sorted(verdicts, key=lambda name: self._style_by_profile[name])
            keeping_mode = next((name for name in order if verdicts[name] == "pass"), None)
            messages.append({
                "type": "mode",
                **dict(zip(_REFERENCE, key, strict=True)),
                "t_s": round((key[-1] - drive_start_ns) / 1e9, 6),
                "mode": keeping_mode,
                "verdicts": {name: verdicts[name] for name in order},
            })  # fmt: skip
        return messages
