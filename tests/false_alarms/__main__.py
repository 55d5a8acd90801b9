"""`python -m tests.false_alarms [--pieces 3] [--seconds 300] [--folder DIR] [--sumo-only | --real-only]`: findings in ordinary driving."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from .count import SUMO, Count, real, simulated, together

SEVERITIES = ("critical", "major", "minor")


def main() -> int:
    """Simulate and check, then print findings of stable rules per 100 km (SUMO) and per hour (real logs), by severity and by rule."""
    parser = argparse.ArgumentParser(prog="python -m tests.false_alarms", description=__doc__)
    parser.add_argument("--seconds", type=int, default=300, help="of traffic on each of SUMO's roads, each time")
    parser.add_argument("--pieces", type=int, default=3, help="how many times, with another seed each")
    parser.add_argument("--folder", type=Path, help="keep the files here")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--sumo-only", action="store_true")
    which.add_argument("--real-only", action="store_true")
    asked = parser.parse_args()
    with TemporaryDirectory() as temporary:
        folder = asked.folder or Path(temporary)
        if not asked.real_only:
            counts = [simulated(name, folder / name, asked.pieces, asked.seconds) for name in SUMO]
            print(table(counts, "per 100 km", [c.km / 100 for c in counts]))
        if not asked.sumo_only:
            counts = list(real(folder / "real"))
            print(table(counts, "per hour", [c.hours for c in counts], wide=False))
    return 0


def table(counts: list[Count], unit: str, exposure: list[float], *, wide: bool = True) -> str:
    """Return the rates in lines: one line per log and severity, then one per rule (a column per log where `wide`, else the sum)."""
    lines = [f"findings of stable rules {unit} of driving (every vehicle as ego)", ""]
    lines += [f"{'':34}{'km':>9}{'hours':>8}" + "".join(f"{severity:>10}" for severity in SEVERITIES)]
    for count, share in zip(counts, exposure, strict=True):
        sums = [sum(n for (severity, _), n in count.findings.items() if severity == wanted) for wanted in SEVERITIES]
        rates = "".join(f"{_rate(n, share):>10}" for n in sums)
        lines.append(
            f"{count.name:34}{count.km:9.1f}{count.hours:8.3f}{rates}{'  ' + count.problem if count.problem else ''}"
        )
    columns = counts if wide else [together("all", counts)]
    shares = exposure if wide else [sum(exposure)]
    lines += ["", f"{'severity':10}{'rule':34}" + "".join(f"{c.name:>12}{'n':>6}" for c in columns)]
    rules = {key for count in columns for key in count.findings}
    for severity, rule in sorted(rules, key=lambda key: (SEVERITIES.index(key[0]), key[1])):
        cells = [(c.findings.get((severity, rule), 0), share) for c, share in zip(columns, shares, strict=True)]
        where = "" if wide else "  " + ", ".join(c.name for c in counts if (severity, rule) in c.findings)
        lines.append(f"{severity:10}{rule:34}" + "".join(f"{_rate(n, share):>12}{n:6}" for n, share in cells) + where)
    return "\n".join([*lines, ""])


def _rate(n: int, share: float) -> str:
    return f"{n / share:.2f}" if share > 0 else "-"


if __name__ == "__main__":
    sys.exit(main())
