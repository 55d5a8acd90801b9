"""A law: a log that lacks a whole quantity goes through every command and output, and what needs the quantity is unknown."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import pyarrow.parquet as pq
import pytest

from drivelint import cli
from tests.formats.opendrive.xodr import geometry, lane, road, section, xodr
from tests.shared_data import ROOT, shared

if TYPE_CHECKING:
    from pathlib import Path

Command = Callable[..., str]

COLUMNS = {
    "size": ("length", "width"),
    "heading": ("yaw",),
    "velocity": ("vx", "vy"),
    "position": ("x", "y"),
    "everything": ("x", "y", "yaw", "vx", "vy", "length", "width"),
}
READ_AS = ("x", "y", "yaw", "vx", "vy", "length", "width")
MAPPING = (
    '[time]\ncolumn = "t"\n[columns]\nactor_id = "id"\n'
    + "".join(f'{name} = "{name}"\n' for name in READ_AS)
    + '[class]\ncolumn = "kind"\ndefault = "car"\n[ego]\nids = ["ego"]\n'
)
RULES = [
    part
    for rule in (
        "no-collision",
        "r124.speed-limit",
        "r126.*",
        "r131.*",
        "r143.direction",
        "r145.off-road",
        "r162.*",
        "r163.*",
    )
    for part in ("--rules", f"ukhc.{rule}")
]
REPORTS = ("html", "junit", "sarif", "xqar", "markdown")


def state(k: int, name: str) -> dict[str, Any]:
    """Return where somebody is at a step of a tenth of a second: an ego too fast behind a slow car, another and a pedestrian."""
    t = k / 10
    x, y, yaw, vx, vy = {
        "ego": (30 * t, -1.75, 0.0, 30.0, 0.0),
        "lead": (60 + 15 * t, -1.75, 0.0, 15.0, 0.0),
        "oncoming": (300 - 20 * t, 1.75, 3.14159, -20.0, 0.0),
        "walker": (150.0, -8 + t, 1.5708, 0.0, 1.0),
    }[name]
    walks = name == "walker"
    return {
        "t": t, "id": name, "kind": "pedestrian" if walks else "car", "x": x, "y": y, "yaw": yaw, "vx": vx, "vy": vy,
        "length": 0.5 if walks else 4.5, "width": 0.5 if walks else 1.8,
    }  # fmt: skip


class Log(NamedTuple):
    """A log, its mapping and its map."""

    table: Path
    mapping: Path
    road: Path

    @property
    def options(self) -> tuple[str, ...]:
        return str(self.table), "--mapping", str(self.mapping), "--map", str(self.road), "--handedness", "rht"


def write_log(tmp_path: Path, absent: str, actors: str) -> Log:
    """Write a log of 4 s in which some columns are empty: for all, for the ego or for all others."""
    lines = [",".join(state(0, "ego"))]
    for k in range(40):
        for name in ("ego", "lead", "oncoming", "walker"):
            row = state(k, name)
            if actors == "all" or (name == "ego") == (actors == "ego"):
                row |= dict.fromkeys(COLUMNS[absent], "")
            lines.append(",".join(map(str, row.values())))
    table, mapping, drawn = tmp_path / "log.csv", tmp_path / "m.toml", tmp_path / "road.xodr"
    table.write_text("\n".join(lines) + "\n", "utf-8")
    mapping.write_text(MAPPING, "utf-8")
    limit = '<type s="0" type="rural"><speed max="80" unit="km/h"/></type>'
    drawn.write_text(
        xodr(
            road(
                geometry=geometry("<line/>", at=(-200, 0, 0), length=900),
                length=900.0,
                lanes=section(0, lane(1), lane(-1)),
                more=limit,
            )
        ),
        "utf-8",
    )
    return Log(table, mapping, drawn)


@pytest.fixture
def command(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Command:
    """Return a function that runs a command in this process, wants it to do its work, and returns what it prints.

    `decides`: whether any rule can be decided; a check that decides nothing has the exit code 4.
    """

    def run(*args: object, decides: bool = True) -> str:
        monkeypatch.setattr(sys, "argv", ["drivelint", *map(str, args)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        out, err = capfd.readouterr()
        assert left.value.code in ({0, 1, 3} if decides else {4}), (args, err)
        assert "internal error" not in out + err
        return out

    return run


@pytest.mark.sample(0, ci=2)
@pytest.mark.parametrize("actors", ["all", "ego", "others"])
@pytest.mark.parametrize("absent", COLUMNS)
def test_every_output_is_written(absent: str, actors: str, tmp_path: Path, command: Command) -> None:
    log, out = write_log(tmp_path, absent, actors), tmp_path / "out"
    decides = absent not in {"position", "everything"} or actors == "others"
    options = ("--margins", "--keep-db", "--annotate", "--no-robustness")
    command("check", *log.options, *RULES, "--out", out, *options, decides=decides)
    counts = json.loads((out / "summary.json").read_text("utf-8"))
    assert counts["drives"], counts
    for kind in REPORTS:
        command("report", out, "--to", kind)
    verdicts, findings = (pq.read_table(out / f"{name}.parquet").to_pylist() for name in ("verdicts", "findings"))
    assert "error" not in {row["verdict"] for row in verdicts}
    for row in findings[:1]:
        command("explain", row["finding_id"], "--in", out)
        command("report", out, "--incident", row["finding_id"])
    for row in list({row["reason_code"]: row for row in verdicts}.values())[:2]:
        command("explain", f"{row['rule_id']}@{row['drive_id']}", "--in", out)
    for kind in ("mcap", "parquet"):
        command("convert", *log.options[:3], "--to", kind, "--out", tmp_path / kind)
    command("inspect", *log.options)
    # boxes that are not known do not touch, and pass only where they are too far apart whatever their headings
    contact = {row["verdict"] for row in verdicts if row["rule_id"] == "ukhc.no-collision"}
    if absent in {"size", "everything"} or (absent == "position" and actors != "others"):
        assert contact == {"unknown"}
    elif absent in {"heading", "position"}:
        assert "unknown" in contact


@pytest.mark.slow
@pytest.mark.parametrize("actors", ["all", "ego", "others"])
@pytest.mark.parametrize("absent", COLUMNS)
@pytest.mark.parametrize("name", ["audit", "watch"])
def test_it_is_audited_and_watched(name: str, absent: str, actors: str, tmp_path: Path) -> None:
    log = write_log(tmp_path, absent, actors)
    more = ["--out", str(tmp_path / "fleet")] if name == "audit" else ["--replay", "0", "--every", "2"]
    done = subprocess.run(
        [sys.executable, "-m", "drivelint", name, *log.options, *more],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
    )
    assert done.returncode in {0, 1, 3}, done.stderr
    assert "internal error" not in done.stdout + done.stderr


@pytest.mark.ci
def test_the_table_without_sizes_of_a_public_report(tmp_path: Path, command: Command) -> None:
    """One car at 108 km/h where 80 are allowed, and nobody knows how long it is: a result with a finding."""
    folder = shared("reported/no_sizes")
    command(
        "check", folder / "n.csv", "--mapping", folder / "n.toml", "--map", folder / "road.xodr", "--out", tmp_path / "out",
        "--rules", "ukhc", "--no-robustness",
    )  # fmt: skip
    findings = pq.read_table(tmp_path / "out" / "findings.parquet").to_pylist()
    assert [(row["rule_id"], row["observed"]) for row in findings] == [("ukhc.r124.speed-limit", pytest.approx(30.0))]
    scenes = pq.read_table(tmp_path / "out" / "scenes.parquet").to_pylist()
    assert [row["geom"] for row in scenes] == [None] * len(scenes)
