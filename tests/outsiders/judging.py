"""Each outsider's drives judged in one run by every stable rule and those that they name, as planned and as driven."""

from __future__ import annotations

from collections import defaultdict
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

from drivelint import catalogue
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions, check

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tests.outsiders.log import Scene
    from tests.scenes import Row

PERSONS: Final = (
    "eighth",
    "ninth",
    "tenth",
    "eleventh",
    "twelfth",
    "thirteenth",
    "fourteenth",
)
"""The outsiders' packages. Each is imported when its drives are wanted: together they are 20,000 lines."""
FAILS: Final = Path(__file__).with_name("fails.txt")
REFUSED: Final = "refused"
"""The verdict on a drive that could not be judged."""
_WORST: Final = ("error", "fail", "unknown", "pass", "not_applicable")
_MET: Final = {
    "fail": {"fail"},
    "pass": {"pass"},
    "not fail": {"pass", "unknown", "not_applicable", REFUSED},
    "not pass": {"fail", "unknown", "not_applicable", REFUSED},
    "unknown": {"unknown"},
}

Key = tuple[str, str]  # scene, rule


class Drive(Protocol):
    """A drive of one of the outsiders."""

    @property
    def scene(self) -> Scene:
        """What happens, and what is expected."""

    def write(self, folder: Path) -> None:
        """Write it into a folder of its name."""


class Judged(NamedTuple):
    """The scenes of an outsider, and the rows of verdicts by scene and rule."""

    scenes: list[Scene]
    rows: dict[Key, list[Row]]

    def verdict(self, key: Key) -> str:
        """Return the verdict of a rule on a drive: its worst row's."""
        verdicts = {row["verdict"] for row in self.rows.get(key, ())}
        return next((verdict for verdict in _WORST if verdict in verdicts), REFUSED)

    def differing(self) -> dict[Key, str]:
        """Return where product and outsider differ, with what was expected, what came, and why."""
        found = {}
        for scene in self.scenes:
            for rule, expected in scene.expect.items():
                verdict = self.verdict((scene.name, rule))
                if verdict not in _MET[expected]:
                    found[scene.name, rule] = f"{expected}, but {verdict}: {self._why((scene.name, rule), verdict)}"
        return found

    def fails(self) -> list[str]:
        """Return the fails of stable rules that are critical or major, one line each: the scene and the rule."""
        stable = {rule.id for rule in catalogue.load_rules().values() if rule.status == "stable"}
        grave = {
            key
            for key, rows in self.rows.items()
            for row in rows
            if key[1] in stable and row["verdict"] in {"fail", "error"} and row["severity"] in {"critical", "major"}
        }
        return [f"{scene} {rule}" for scene, rule in sorted(grave)]

    def _why(self, key: Key, verdict: str) -> str:
        return "; ".join(sorted({row["reason"] for row in self.rows.get(key, ()) if row["verdict"] == verdict}))


def drives(person: str) -> list[Drive]:
    """Return the drives of an outsider's package."""
    drawn: list[Drive] = import_module(f"tests.outsiders.{person}").drives()
    return drawn


def judge(person: str, folder: Path) -> Judged:
    """Write the drives of an outsider into an empty folder and judge them."""
    drawn = drives(person)
    for drive in drawn:
        drive.write(folder)
    scenes = [drive.scene for drive in drawn]
    named = {rule for scene in scenes for rule in scene.expect}
    settings = CheckOptions(
        (str(folder),),
        rules=("status:stable", *sorted(named)),
        profiles=("nominal", "observed"),
        robustness=False,
    )
    return Judged(scenes, _by_scene(check(settings, Silent()).verdicts.to_pylist()))


def _by_scene(rows: Iterable[Row]) -> dict[Key, list[Row]]:
    found = defaultdict(list)
    for row in rows:
        found[row["drive_id"].rpartition("-")[0], row["rule_id"]].append(row)
    return dict(found)
