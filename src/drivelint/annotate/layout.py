"""The layout that Foxglove and Lichtblick import: `layout.json`, and a line in its plot of margins for each rule of the run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from drivelint.annotate.measures import margin_topic

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.annotate.measures import Series

MAX_SERIES: Final = 10
"""So many lines a person can tell apart; the margins of further rules have their topics all the same."""
_MARGINS: Final = "Plot!drivelint-margins"


def layout(series: Iterable[Series]) -> bytes:
    """Return the layout whose plot of margins shows the worst rules; the same series give the same bytes."""
    content = json.loads((Path(__file__).parent / "layout.json").read_bytes())
    content["configById"][_MARGINS]["paths"] += [_path(one) for one in sorted(series)[:MAX_SERIES]]
    return json.dumps(content, indent=2).encode() + b"\n"


def _path(one: Series) -> dict[str, Any]:
    topic = f"/drivelint/{margin_topic(one.rule_id)}"
    profile = f" [{one.profile}]" if one.profile else ""
    only = f'{{profile=="{one.profile}"}}' if one.profile else ""
    unit = f" ({one.unit})" if one.unit else ""
    return {
        "value": f"{topic}{only}.margin",
        "label": f"{one.rule_id.partition('.')[2]}{profile}{unit}",
        "enabled": True,
        "timestampMethod": "receiveTime",
    }
