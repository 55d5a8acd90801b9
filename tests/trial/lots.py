"""Judges the perception logs, once each, and draws findings by lot."""

from __future__ import annotations

import json
import random
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import drivelint
from drivelint.sql import store
from tests.shared_data import DATA
from tests.waymo_json import write

from .sheet import draw_sheet

if TYPE_CHECKING:
    from collections.abc import Collection

LOGS = {
    "av2/adcf7d18": "argoverse",
    "av2/3b3570b4": "argoverse",
    "av2_forecasting": "argoverse",
    "d123/av2-sensor_val/adcf7d18-0510-35b0-a2fa-b4cea13a6d76": "argoverse",
    "scenarionet/sd_nuscenes_v1.0-mini_scene-0553.pkl": "nuscenes",
    "scenarionet/sd_nuscenes_v1.0-mini_scene-1077.pkl": "nuscenes",
    "scenarionet/sd_nuscenes_v1.0-mini_scene-1094.pkl": "nuscenes",
    "scenarionet/sd_waymo_v1.2_eb4b91b10ca94ff2.pkl": "waymo",
    "waymo_json/gpudrive_w4.json": "waymo",
    "waymo_json/gpudrive_w407.json": "waymo",
    "waymo_json/nocturne_n65.json": "waymo",
    "waymo_json/nocturne_n171.json": "waymo",
}
"""Log, below the folder `perception` of the reference data, and the data set that it is of."""
MOVED_M = 2.0
"""An ego that stays within this of one place is parked or waits: its findings are not drawn, unless it recorded the log."""


class Result(NamedTuple):
    """The results of one log: folder with tables and the kept database."""

    log: str
    source: str
    folder: Path

    def rows(self, query: str) -> list[dict[str, Any]]:
        """Return the rows of a query in which `{name}` stands for a table of the results."""
        tables = {path.stem: f"read_parquet('{path}')" for path in self.folder.glob("*.parquet")}
        with store.open_without_creating_tables() as con:
            answer = con.execute(query.format(**tables))
            names = [column[0] for column in answer.description or ()]
            return [dict(zip(names, row, strict=True)) for row in answer.fetchall()]


def results(folder: Path, *, copies: bool = True) -> list[Result]:
    """Judge the logs that were not judged yet, and return the results of all. `copies`: also those with recording errors."""
    judged = []
    for log, source in LOGS.items():
        out = folder / "results" / "".join(letter if letter.isalnum() else "-" for letter in log)
        path = _source(log, folder / "logs")
        if not (out / "findings.parquet").exists():
            print(f"judging {log}", file=sys.stderr, flush=True)
            command = [
                sys.executable,
                "-m",
                "drivelint",
                "check",
                str(path),
                "--ego",
                "all",
                "--rules",
                "status:stable",
            ]
            command += ["--fail-on", "never", "--no-annotate", "--keep-db", "--quiet", "--out", str(out)]
            command += [] if copies else ["--no-robustness"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if not (out / "findings.parquet").exists():
                print(f"{log}: exit {done.returncode}: {done.stderr.strip()[-300:]}", file=sys.stderr)
                continue
        if not (out / "recorders.json").exists():
            egos = [row["actor_id"] for row in drivelint.read_trace(path).tables["actor"].rows() if row["is_ego"]]
            (out / "recorders.json").write_text(json.dumps(egos), encoding="utf-8")
        judged.append(Result(log, source, out))
    return judged


def draw(folder: Path, seed: int, count: int, *, copies: bool = True, without: Collection[str] = ()) -> int:
    """Draw findings by lot, write their sheets and the key, and return how many. `without`: ids of rules that are left out."""
    lots = [(result, row) for result in results(folder, copies=copies) for row in _findings(result)]
    lots = [lot for lot in lots if lot[1]["rule_id"] not in without]
    lots.sort(key=lambda lot: (lot[0].log, lot[1]["finding_id"]))
    taken = random.Random(seed).sample(lots, min(count, len(lots)))  # noqa: S311
    sheets = folder / "sheets"
    sheets.mkdir(parents=True, exist_ok=True)
    key = {}
    for number, (result, row) in enumerate(taken, 1):
        draw_sheet(result, row, number, sheets / f"{number:03}.png")
        key[number] = {
            "log": result.log,
            "source": result.source,
            "recorder": row["is_recorder"],
            "sure": None if row["n_copies"] is None else row["n_stays"] >= 0.95 * row["n_copies"],
            **{name: row[name] for name in _KEY_COLUMNS},
        }
    text = json.dumps({"seed": seed, "of": len(lots), "sheets": key}, indent=1, default=str)
    (folder / "key.json").write_text(text + "\n", encoding="utf-8")
    return len(taken)


_KEY_COLUMNS = (
    "finding_id",
    "drive_id",
    "ego_id",
    "object_id",
    "rule_id",
    "profile",
    "severity",
    "t_worst_s",
    "reason",
)


def _findings(result: Result) -> list[dict[str, Any]]:
    """Return the findings of a log whose ego moves or recorded it, with what the rule says."""
    recorders = _recorders(result)
    found = result.rows(
        """
        SELECT f.* EXCLUDE (geom), r.title, r.clause, r.hypothesis, r.observes,
            greatest(list_max(t.x) - list_min(t.x), list_max(t.y) - list_min(t.y)) AS moved_m
        FROM {findings} AS f
        JOIN {rules} AS r USING (rule_id)
        LEFT JOIN (
            SELECT drive_id, actor_id, flatten(list(x_m)) AS x, flatten(list(y_m)) AS y FROM {tracks} GROUP BY ALL
        ) AS t ON t.drive_id = f.drive_id AND t.actor_id = f.ego_id
        WHERE r.status = 'stable'
        """
    )
    for row in found:
        row["is_recorder"] = row["ego_id"] in recorders
    return [row for row in found if row["is_recorder"] or (row["moved_m"] or 0.0) > MOVED_M]


def _recorders(result: Result) -> set[str]:
    """Return the ids under which the recording vehicle is an ego: what a check without `--ego all` judges."""
    return set(json.loads((result.folder / "recorders.json").read_text(encoding="utf-8")))


def _source(log: str, folder: Path) -> Path:
    """Return the file to judge: JSON of Waymo is made a scenario of ScenarioNet first."""
    path = DATA / "perception" / log
    if path.suffix != ".json":
        return path
    folder.mkdir(parents=True, exist_ok=True)
    return write(path, folder)
