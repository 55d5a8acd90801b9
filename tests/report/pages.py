"""Report pages of made-up results, parsed."""

from __future__ import annotations

from html.parser import HTMLParser

from drivelint.result.model import Result
from tests.report.synthetic import SECOND, drive, finding, rule, table, verdict

NASTY = "<script>alert(1)</script>\"'&</style></svg><img src=x onerror=alert(2)>"


def page(run: Result) -> str:
    from drivelint.report.html import render

    return render(run).decode()


class Parsed(HTMLParser):
    """Tags, ids and links of a page, and where tags do not match."""

    VOID = frozenset({"meta", "link", "br", "img", "input", "hr"})
    SVG_LEAVES = frozenset({"path", "rect", "circle", "use"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] not in {"script", "style"}:
            self.text += data

    def values(self, attribute: str) -> list[str]:
        return [value for _, attrs in self.tags if (value := attrs.get(attribute)) is not None]


def nasty() -> Result:
    """Return a result in which everything that a log, a map or a rule names is markup."""
    names = {"drive_id": NASTY, "ego_id": NASTY, "object_id": NASTY, "reason": NASTY, "unit": NASTY, "profile": NASTY}
    check = {"check_id": NASTY, "severity": "warning", "actor_id": NASTY, "n": 1, "t_first_ns": 0, "message": NASTY}
    shape = {"left_x_m": [-50.0, 50.0], "left_y_m": [2.0, 2.0], "right_x_m": [-50.0, 50.0], "right_y_m": [-2.0, -2.0]}
    actor = {
        "actor_id": NASTY, "actor_class": NASTY, "length_m": 4.0, "width_m": 2.0, "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0,
        "speed_mps": 1.0, "path": [],
    }  # fmt: skip
    return Result(
        table(
            "verdict", [verdict("fail", **names), verdict("unknown", **names), verdict("pass", near_miss=True, **names)]
        ),
        table("finding", [finding(**names)]),
        table(
            "drive",
            [
                drive(
                    NASTY,
                    file_name=NASTY,
                    format=NASTY,
                    map_name=NASTY,
                    sha256=NASTY,
                    map_sha256=NASTY,
                    quality=[check],
                    not_judged=[{"ego_id": NASTY, "signal": NASTY, "reason": NASTY}],
                ),
                drive("lost", status="not_judged", status_reason=NASTY, file_name=NASTY),
            ],
        ),
        table(
            "rule",
            [
                rule(
                    title=NASTY,
                    clause=NASTY,
                    hypothesis=NASTY,
                    unit=NASTY,
                    profiles=[NASTY],
                    requires=[NASTY],
                    params=[{"name": NASTY, "value": NASTY, "unit": NASTY, "overridden": True}],
                )
            ],
        ),
        table(
            "scene",
            [
                {
                    "drive_id": NASTY,
                    "ego_id": NASTY,
                    "t_ns": 108 * SECOND,
                    "environment_id": NASTY,
                    "reach_m": 60.0,
                    "lanelets": [NASTY],
                    "actors": [actor, actor | {"actor_id": NASTY + "2", "x_m": 9.0}],
                }
            ],
        ),
        table(
            "lane_shape",
            [
                {
                    "environment_id": NASTY,
                    "lanelet_id": NASTY,
                    "lane_type": NASTY,
                    "drivable": True,
                    "in_junction": False,
                    **shape,
                }
            ],
        ),
    )
