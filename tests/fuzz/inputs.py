"""Damaged maps and text files: mappings, rules, waivers, and a result that is a baseline."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import drivelint
from drivelint.catalogue.load import read_rule
from drivelint.drive.trace import IngestOptions
from drivelint.formats import load_map, read_source, read_trace
from drivelint.gate import GateInputs, descriptions, waivers
from drivelint.resources import folder as resource
from drivelint.result.load import load_result
from tests.fuzz import small_maps, sources
from tests.fuzz.mutations import BINARY, TEXT, XML, mutated
from tests.fuzz.outcome import of_error

if TYPE_CHECKING:
    from collections.abc import Callable
    from random import Random

TODAY: Final = date(2026, 11, 20)
WAIVERS: Final = """
[[waiver]]
rule = "ukhc.no-collision"
drive = "*collision*"
reason = "ticket 17"
owner = "jo"
expires = 2027-03-31
from_s = 1
to_s = 9.5

[[waiver]]
rule = "ukhc.*"
object = "3"
reason = "the test track"
owner = "jo"
expires = "2026-03-31"
"""
RULE_NAMES: Final = ("no-collision", "r126.two-second", "r103.signal-turn", "r131.keep-in-lane")


@dataclass
class Input:
    """A valid file or folder of files, and what reads it. `use` returns what was read, to be compared with the whole one's."""

    name: str
    files: dict[str, bytes]
    ways: tuple[Callable[[bytes, Random], bytes], ...]
    use: Callable[[Path, int], Any]

    def damaged(self, rng: Random) -> dict[str, bytes]:
        """Damage one of the files."""
        name = rng.choice(sorted(self.files))
        text = not name.endswith(".parquet")
        return {name: mutated(self.files[name], rng, self.ways if text else BINARY)}

    def write(self, folder: Path, changes: dict[str, bytes] | None = None) -> Path:
        """Write the files, some of them changed, and return their folder."""
        for name, data in {**self.files, **(changes or {})}.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(data)
        return folder


def use_case(case: Input, folder: Path, number: int, whole: Any) -> tuple[str, str]:
    """Use damaged files; return the outcome and its detail."""
    try:
        found = case.use(folder, number)
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # noqa: BLE001 - a panic of a compiled library is no Exception
        return of_error(error)
    return ("same" if found == whole else "other"), ""


def _map(folder: Path, number: int) -> Any:
    environment = load_map(read_source(folder / "road"), origin=(49.0, 8.4))
    if not number % 40:  # a run with rules takes fifty times as long
        result = drivelint.check(
            [sources.SCENES / "collision.mcap"], rules=["ukhc.no-collision", "ukhc.r162.*"], map=folder / "road",
            annotate=False, robustness=False,
        )  # fmt: skip
        _no_internal_error(result)
    tables = {n: t for n, t in environment.tables.items() if n not in {"environment", "map_quality"}}
    names = {n: t.drop_columns([c for c in ("environment_id",) if c in t.schema.names]) for n, t in tables.items()}
    return environment.handedness, names


def _no_internal_error(result: drivelint.CheckResult) -> None:
    for drive in result.drives.arrow().to_pylist():
        if "internal error" in (drive["status_reason"] or ""):
            raise AssertionError(drive["status_reason"])


def opendrive(folder: Path) -> list[Input]:
    """Return OpenDRIVE maps: a road, a junction, a motorway exit, an overpass."""
    names = ("overtake-road", "overtake-at-junction", "exit-road", "bridge", "overtake-on-bend")
    return [Input(name, {"road": (sources.SCENES / f"{name}.xodr").read_bytes()}, XML, _map) for name in names]


def lanelet2(folder: Path) -> list[Input]:
    """Return a Lanelet2 map: a road with a sign, a stop line and a crossing."""
    return [Input("osm", {"road": small_maps.lanelet2().encode()}, XML, _map)]


def other_maps(folder: Path) -> list[Input]:
    """Return maps of CommonRoad and SUMO."""
    return [
        Input("commonroad", {"road": small_maps.commonroad().encode()}, XML, _map),
        Input("sumo", {"road": small_maps.sumo().encode()}, XML, _map),
    ]


def mapping(folder: Path) -> list[Input]:
    """Return mapping files, which are used to read their tables."""
    found = []
    for source in sources.csv(folder):
        whole, path = source.write(folder / f"of-{source.name}"), source.options["mapping"]

        def use(place: Path, _: int, table: Path = whole) -> Any:
            trace = read_trace(table, IngestOptions(mapping=str(place / "mapping.toml"), need_ego=False))
            return trace.tables["actor_state"]

        found.append(Input(source.name, {"mapping.toml": Path(path).read_bytes()}, TEXT, use))
    return found


def rule(folder: Path) -> list[Input]:
    """Return rule files, some of which are run where they are still accepted."""
    drive = sources.osi_mcap(folder)[0].write(folder / "drive")

    def use(place: Path, number: int) -> Any:
        found = read_rule(place / "fuzz" / "rule.sql")
        if not number % 20:
            result = drivelint.check(
                [drive], rules="fuzz.rule", rules_dir=place, map=sources.SCENES / "two-lane-road.xodr", annotate=False,
                robustness=False, rule_timeout=5,
            )  # fmt: skip
            _no_internal_error(result)
        return found.sections, found.params

    pack = resource("queries") / "assertions" / "ukhc"
    return [Input(name, {"fuzz/rule.sql": (pack / f"{name}.sql").read_bytes()}, TEXT, use) for name in RULE_NAMES]


def waiver(folder: Path) -> list[Input]:
    """Return a file of waivers, applied to a result with findings."""
    result = load_result(_result_folder(folder))

    def use(place: Path, _: int) -> Any:
        said = waivers.read(place / "waivers.toml")
        return GateInputs(TODAY, waivers=tuple(said)).apply_to(result).gate.waived if said else {}  # type: ignore[union-attr]

    return [Input("waivers", {"waivers.toml": WAIVERS.encode()}, TEXT, use)]


def baseline(folder: Path) -> list[Input]:
    """Return the folder of a result, to which that result is compared as to its baseline."""
    out = _result_folder(folder)
    result = load_result(out)

    def use(place: Path, _: int) -> Any:
        inputs = GateInputs.from_files(place, None, None, TODAY, None)
        assert inputs is not None
        gate = inputs.apply_to(result).gate
        assert gate is not None
        assert gate.baseline is not None
        failing = descriptions.gating_findings(gate.baseline, "critical", gate)
        descriptions.to_json(gate.baseline, failing, "critical")
        return gate.baseline.counts(), descriptions.exit_code(gate.baseline, failing, "critical")

    files = [file for file in sorted(out.iterdir()) if file.suffix in {".json", ".parquet"}]
    return [Input("result", {file.name: file.read_bytes() for file in files}, TEXT, use)]


def _result_folder(folder: Path) -> Path:
    out = folder / "result"
    drivelint.check(
        [sources.SCENES / "collision.mcap"], rules=["ukhc.no-collision", "ukhc.r162.*"], map=sources.SCENES / "overtake-road.xodr",
        annotate=False, robustness=False, out=out,
    )  # fmt: skip
    return out


INPUTS: Final[dict[str, Callable[[Path], list[Input]]]] = {
    "opendrive": opendrive,
    "lanelet2": lanelet2,
    "other-map": other_maps,
    "mapping": mapping,
    "rule": rule,
    "waiver": waiver,
    "baseline": baseline,
}
