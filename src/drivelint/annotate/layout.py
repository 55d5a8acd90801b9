"""Makes the layout that Foxglove and Lichtblick import: `layout.json`, with a line per rule in its plot of margins."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from drivelint.annotate.measures import margin_topic

if TYPE_CHECKING:
    from collections.abc import Iterable

    from drivelint.annotate.measures import MarginSeries

MAX_SERIES: Final = 10
"""The most lines of the plot, as a person cannot distinguish more; the margins of further rules are in their topics."""
_MARGIN_PLOT_ID: Final = "Plot!drivelint-margins"


def layout_json(series: Iterable[MarginSeries]) -> bytes:
    """Return the layout whose plot of margins shows the worst rules; the same series give the same bytes."""
    content = json.loads((Path(__file__).parent / "layout.json").read_bytes())
    content["configById"][_MARGIN_PLOT_ID]["paths"] += [
        _plot_line(rule_series) for rule_series in sorted(series)[:MAX_SERIES]
    ]
    return json.dumps(content, indent=2).encode() + b"\n"


def _plot_line(series: MarginSeries) -> dict[str, Any]:
    topic = f"/drivelint/{margin_topic(series.rule_id)}"
    profile = f" [{series.profile}]" if series.profile else ""
    only = f'{{profile=="{series.profile}"}}' if series.profile else ""
    unit = f" ({series.unit})" if series.unit else ""
    return {
        "value": f"{topic}{only}.margin",
        "label": f"{series.rule_id.partition('.')[2]}{profile}{unit}",
        "enabled": True,
        "timestampMethod": "receiveTime",
    }
