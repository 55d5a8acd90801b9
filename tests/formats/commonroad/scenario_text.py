"""CommonRoad scenarios as XML."""

from __future__ import annotations


def bound(tag: str, points: list[tuple[float, float]], marking: str = "") -> str:
    inner = "".join(f"<point><x>{x}</x><y>{y}</y></point>" for x, y in points)
    return f"<{tag}>{inner}{f'<lineMarking>{marking}</lineMarking>' if marking else ''}</{tag}>"


def lanelet(name: int, y: float, more: str = "", *, x: float = 0.0, left: str = "dashed", right: str = "solid") -> str:
    a, b = [(x, y + 1.75), (x + 50, y + 1.75)], [(x, y - 1.75), (x + 50, y - 1.75)]
    return f'<lanelet id="{name}">{bound("leftBound", a, left)}{bound("rightBound", b, right)}{more}</lanelet>'


def scenario(*parts: str, benchmark: str = "ZAM_Test-1") -> str:
    return f'<commonRoad commonRoadVersion="2020a" benchmarkID="{benchmark}" timeStepSize="0.1">{"".join(parts)}</commonRoad>'


def state(tag: str, step: int, x: float, y: float, yaw: float) -> str:
    """Return a state of an obstacle that goes with 8 m/s."""
    return (
        f"<{tag}><position><point><x>{x!r}</x><y>{y!r}</y></point></position><orientation><exact>{yaw!r}</exact></orientation>"
        f"<time><exact>{step}</exact></time><velocity><exact>8.0</exact></velocity></{tag}>"
    )
