"""Signals of OpenDRIVE as XML."""

from __future__ import annotations

WIDTH = '<width sOffset="0" a="3.5"/>'


def signal(s: float, orientation: str = "+", inside: str = "", **attributes: str) -> str:
    said = {"id": "7", "t": "-5", "type": "206", "country": "DE", "dynamic": "no", **attributes}
    text = " ".join(f'{k}="{v}"' for k, v in said.items())
    return f'<signal s="{s}" orientation="{orientation}" {text}>{inside}</signal>'
