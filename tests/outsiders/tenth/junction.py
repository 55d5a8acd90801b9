"""Junctions of roads that end at them."""

from __future__ import annotations

import math

from tests.outsiders.tenth.road import Lane, Road, Section, xodr
from tests.outsiders.tenth.ways import Path, join

FOUR = {"S": -90.0, "E": 0.0, "N": 90.0, "W": 180.0}
TEE = {"S": -90.0, "E": 0.0, "W": 180.0}


class Cross:
    """A junction of roads that end at it; each road's s runs away from it."""

    def __init__(
        self,
        nation: str,
        arms: dict[str, float],
        *,
        reach: float = 12.0,
        lanes: int = 1,
        kind: str = "town",
        speed: tuple[float, str] | None = (30.0, "mph"),
        length: float = 150.0,
        width: float = 3.5,
        walk: float = 2.0,
        turn: float = 0.0,
        centre: str = "broken",
    ) -> None:
        """Draw it; the arms' headings are in degrees, away from the junction."""
        self.side = 1 if nation == "gb" else -1
        self.rule = "LHT" if nation == "gb" else "RHT"
        self.width, self.lanes, self.reach = width, lanes, reach
        self.arms: dict[str, Road] = {}
        self.inner: dict[tuple[str, str], Road] = {}
        foot = (Lane("sidewalk", walk, "none"),) if walk else ()
        drive = tuple(Lane("driving", width, "solid" if i == lanes - 1 else "broken") for i in range(lanes))
        for i, (name, degrees) in enumerate(arms.items()):
            h = math.radians(degrees) + turn
            start = (reach * math.cos(h), reach * math.sin(h), h)
            self.arms[name] = Road(
                i + 1,
                start,
                [(length, 0.0)],
                [Section(0.0, drive + foot, drive + foot, centre)],
                self.rule,
                kind,
                speed,
                links='<predecessor elementType="junction" elementId="100"/>',
            )
        connections, n = "", 0
        inner = tuple(Lane("driving", width, "none") for _ in range(lanes))
        for a, ra in self.arms.items():
            for b, rb in self.arms.items():
                if a == b:
                    continue
                n += 1
                bend = math.remainder(rb.start[2] - (ra.start[2] + math.pi), 2 * math.pi)
                x, y, h = ra.start[0], ra.start[1], ra.start[2] + math.pi
                if abs(bend) < 1e-6:
                    pieces = [(2 * reach, 0.0)]
                else:
                    radius = reach / math.tan(abs(bend) / 2)
                    pieces = [(radius * abs(bend), math.copysign(1 / radius, bend))]
                own = (inner, ()) if self.side > 0 else ((), inner)
                road = Road(
                    20 + n,
                    (x, y, h),
                    pieces,
                    [Section(0.0, own[0], own[1], "none")],
                    self.rule,
                    kind,
                    speed,
                    100,
                    f'<predecessor elementType="road" elementId="{ra.id}" contactPoint="start"/>'
                    f'<successor elementType="road" elementId="{rb.id}" contactPoint="start"/>',
                )
                road.ends = (lambda k: -k, lambda k: k)
                self.inner[a, b] = road
                pairs = "".join(
                    f'<laneLink from="{-self.side * k}" to="{self.side * k}"/>' for k in range(1, lanes + 1)
                )
                connections += (
                    f'<connection id="{n}" incomingRoad="{ra.id}" connectingRoad="{road.id}" contactPoint="start">'
                    f"{pairs}</connection>"
                )
        self.junction = f'<junction id="100" name="j" type="default">{connections}</junction>\n'

    def t(self, n: int) -> float:
        """The offset of lane n of traffic away from the junction."""
        return self.side * self.width * (n - 0.5)

    def way(self, a: str, b: str, n: int = 1) -> Path:
        """From arm a through the junction to arm b."""
        return join(
            self.arms[a].way(-self.t(n), back=True), self.inner[a, b].way(self.t(n)), self.arms[b].way(self.t(n))
        )

    def lights(
        self, arm: str, s: float = 1.0, *, line_: bool = True, name: str | None = None, gap: float = 0.0
    ) -> None:
        """A light and its stop line for those who come in on the arm."""
        road = self.arms[arm]
        k = -self.side
        road.light(
            name or f"L{arm}",
            s + gap,
            -self.side * (self.width * self.lanes + 0.5),
            "-",
            (k * self.lanes, k) if k < 0 else (k, k * self.lanes),
        )
        if line_:
            self.line(arm, s)

    def line(self, arm: str, s: float = 1.0) -> None:
        """A stop line for those who come in."""
        w = self.width * self.lanes
        self.arms[arm].stop_line(f"S{arm}", s, -self.side * w / 2, "-", w - 0.1)

    def stop(self, arm: str, s: float = 1.0, kind: tuple[str, str] = ("206", "de")) -> None:
        """A stop sign and its line."""
        self.line(arm, s)
        self.arms[arm].sign(f"stop_{arm}", kind[0], kind[1], s, -self.side * (self.width * self.lanes + 0.5), "-")

    def give(self, arm: str, s: float = 1.0, kind: tuple[str, str] = ("602", "gb")) -> None:
        """A give-way sign."""
        self.arms[arm].sign(f"give_way_{arm}", kind[0], kind[1], s, -self.side * (self.width * self.lanes + 0.5), "-")

    @property
    def xml(self) -> str:
        """The map."""
        return xodr([*self.arms.values(), *self.inner.values()], self.junction)
