"""Scenes that break a rule, with the other lost or unknown about that time: no rule may then say that all was well."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest

from drivelint.drive.trace import IngestOptions
from drivelint.engine.batch import Drive
from drivelint.formats import load_map, read_trace
from drivelint.road.map_reader import MapSource
from drivelint.scene import document
from drivelint.scene.scene import MAP_FILE, scenes_of
from tests import blinding
from tests.blinding import EVER
from tests.scene_drives import SCENES, TOPICS
from tests.scenes import verdict_rows

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from drivelint.scene.scene import Scene
    from tests.blinding import Span
    from tests.scenes import Row

ABOUT_S: Final = 10.0
"""Only what is said of this long before and after the breach counts."""
ANY_TIME: Final = {"criticality.pet", "stvo.ri2"}
"""Rules of which one unknown row stands for a longer time, at its first or last step."""
BATCH: Final = 100
EVIDENCE: Final = {
    ("back-before-solid-late", "ukhc.r128.back-before-solid"): "who is first seen far behind need not have been passed",
    ("brakes-late", "criticality.mttc"): "134 m ahead, ten seconds before: who is lost there may have left the road",
}
"""(scene, rule) -> why the rule need not be broken nor unknown any more."""


def scene_drive(scene: Scene, folder: Path) -> Drive:
    """Write the scene into the folder, and return what is read of that."""
    folder.mkdir(parents=True)
    files = scene.files()
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return Drive(read_trace(folder, IngestOptions()), load_map(MapSource(MAP_FILE, files[MAP_FILE])))


def actors(drive: Drive) -> list[str]:
    return list(drive.trace.tables["actor"]["actor_id"].to_pylist())


def lossy_drives(drive: Drive, other_ids: list[str], span: Span) -> Iterator[tuple[str, Drive]]:
    """Return the drive with something of the others taken away, in many ways."""
    begin, end = span
    long = (begin - 0.5, end + 0.5)
    tracks = {
        "early end, 0.3 s": (begin - 0.35, EVER[1]),
        "early end": (begin - 0.02, EVER[1]),
        "late track": (EVER[0], end + 0.02),
        "late track, 0.3 s": (EVER[0], end + 0.35),
        "a second": (begin - 0.5, begin + 0.5),
        "hole from there": (begin - 0.02, end + 1.0),
        "hole until there": (begin - 1.0, end + 0.02),
    }
    for what, span_lost in tracks.items():
        less = drive
        for other in other_ids:
            less = blinding.dropped(less, other, span_lost)
        if actors(less) == actors(drive):
            yield what, less
    columns = {"heading": ("yaw_rad",), "speed": ("vx_mps", "vy_mps"), "place": ("x_m", "y_m")}
    for what, names in columns.items():
        yield what, _without(drive, "actor_state", names, other_ids, long)
    size = _without(drive, "actor", ("length_m", "width_m"), other_ids)
    yield "size", size
    classless = _without(size, "actor", ("actor_class",), other_ids)
    yield "class, heading and size", _without(classless, "actor_state", ("yaw_rad",), other_ids, long)


def _without(drive: Drive, table: str, columns: tuple[str, ...], other_ids: list[str], span: Span = EVER) -> Drive:
    for other in other_ids:
        drive = blinding.without(drive, table, columns, other, span)
    return drive


def hole(drive: Drive, span: Span) -> Drive | None:
    """Return the drive with a hole of a second where the breach begins; None: the log does not go on on both sides."""
    t_s = drive.trace.tables["actor_state"]["t_ns"].to_numpy() / 1e9
    begin, end = span[0] - 0.5, span[0] + 0.5
    return blinding.dropped(drive, None, (begin, end)) if t_s.min() < begin and t_s.max() > end else None


def breaches(drives: dict[str, Drive], fails: dict[str, set[str]]) -> list[tuple[str, Row, Span]]:
    """Return the first row of each drive that breaks a rule, and from when to when."""
    found: dict[tuple[str, str], Row] = {}
    for row in verdict_rows(list(drives.values()), rules=sorted(set().union(*fails.values()))):
        if row["verdict"] == "fail" and row["rule_id"] in fails[row["drive_id"]]:
            found.setdefault((row["drive_id"], row["rule_id"]), row)
    rows = []
    for (name, _), row in found.items():
        times = [row[t] / 1e9 for t in ("t_start_ns", "t_end_ns", "t_ref_ns", "t_worst_ns") if row[t] is not None]
        rows.append((name, row, (min(times), max(times))))
    return rows


def verdicts_near_breach(drives: list[Drive], about: dict[str, tuple[str, Span]]) -> dict[str, set[str]]:
    """Return the verdicts of each drive on its rule about the time of its breach."""
    verdicts: dict[str, set[str]] = {drive.trace.drive_id: set() for drive in drives}
    for first in range(0, len(drives), BATCH):
        batch = drives[first : first + BATCH]
        rules = sorted({about[drive.trace.drive_id][0] for drive in batch})
        for row in verdict_rows(batch, rules=rules):
            rule, (begin, end) = about[row["drive_id"]]
            untimed = rule in ANY_TIME or row["t_start_ns"] is None or row["t_end_ns"] is None
            if row["rule_id"] == rule and (
                untimed or (row["t_start_ns"] / 1e9 <= end + ABOUT_S and row["t_end_ns"] / 1e9 >= begin - ABOUT_S)
            ):
                verdicts[row["drive_id"]].add(row["verdict"])
    return verdicts


@pytest.mark.slow
@pytest.mark.parametrize("topic", TOPICS)
def test_what_is_broken_by_an_actor_is_broken_or_unknown_when_the_actor_is_lost(topic: str, tmp_path: Path) -> None:
    file = document.read(SCENES / f"{topic}.yml")
    fails = {text.name: {rule for rule, v in text.expect.items() if str(v).startswith("fail")} for text in file.scenes}
    scenes = {text.name: scenes_of([text], file.roads)[0] for text in file.scenes if fails[text.name]}
    if not scenes:
        pytest.skip("no scene breaks a rule")
    whole = {name: blinding.renamed(scene_drive(scene, tmp_path / name), name) for name, scene in scenes.items()}
    drives: list[Drive] = []
    about: dict[str, tuple[str, Span]] = {}
    for name, row, span in breaches(whole, fails):
        others = [row["object_id"]] if row["object_id"] else [a for a in actors(whole[name]) if a != row["ego_id"]]
        less = dict(lossy_drives(whole[name], others, span)) if others else {}
        if holed := hole(whole[name], span):
            less["a hole of the log"] = holed
        for what, drive in less.items():
            key = f"{name}/{row['rule_id']}/{what}"
            about[key] = (row["rule_id"], span)
            drives.append(blinding.renamed(drive, key))
    clear = {
        tuple(key.split("/"))
        for key, verdicts in verdicts_near_breach(drives, about).items()
        if not verdicts & {"fail", "unknown"}
    }
    assert not {key for key in clear if key[:2] not in EVIDENCE}
