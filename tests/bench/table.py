"""Rows of the table that the benchmarks print, and the bars they are held against."""

from __future__ import annotations

from typing import NamedTuple


class Bar(NamedTuple):
    """What a value must reach: at most, or at least, `limit`."""

    limit: float
    at_least: bool = False

    def met(self, value: float) -> bool:
        """Whether a value keeps to it."""
        return value >= self.limit if self.at_least else value <= self.limit


class Row(NamedTuple):
    """One line: wall-clock seconds unless the unit says otherwise; `cpu` are the CPU seconds of all threads beside it."""

    section: str
    label: str
    value: float
    unit: str = "s"
    cpu: float | None = None
    bar: Bar | None = None
    note: str = ""


class Skipped(Exception):  # noqa: N818 - not an error: what a comparison needs is not installed
    """Why a section, or a part of it, was not measured."""


def markdown(rows: list[Row]) -> str:
    """Return the rows as a table."""
    lines = ["| section | what | measured | CPU | bar | | note |", "|---|---|---|---|---|---|---|"]
    for row in rows:
        cpu = "" if row.cpu is None else f"{row.cpu:.2f} s"
        bar = "" if row.bar is None else f"{'>=' if row.bar.at_least else '<='} {row.bar.limit:g} {row.unit}"
        verdict = "" if row.bar is None else "met" if row.bar.met(row.value) else "**missed**"
        lines.append(
            f"| {row.section} | {row.label} | {_number(row.value)} {row.unit} | {cpu} | {bar} | {verdict} | {row.note} |"
        )
    return "\n".join(lines)


def _number(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.3g}" if abs(value) < 1 else f"{value:.2f}"
