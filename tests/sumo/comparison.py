"""One simulation, read by drivelint and by hand; then again with contacts planted in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.sumo import compare, contacts, reading, world

if TYPE_CHECKING:
    from pathlib import Path


def run_comparison(folder: Path, seconds: int, seed: int, per_kind: int) -> tuple[dict[str, float], list[str]]:
    """Return the figures of a comparison, and what differs."""
    files = world.simulate(folder / "log", seconds=seconds, seed=seed)
    net = reading.read_net(files.net)
    log = reading.read_log(files.log, files.routes, net)
    read, touched = reading.overtakes(log, net), contacts.contacts(log)
    checked = compare.check(files, folder / "out")
    differ, counts = compare.differences(read, checked, log)
    other, moved = compare.other_contacts(touched, checked.contacts, reading.jumps(log))
    differ += other
    known = checked.overtakes
    apart = [abs(o.da_m - known[key]["da_m"]) for o in read if (key := compare.known_by(o)) in known]
    figures: dict[str, float] = {
        "vehicles, each of them ego": len(log.ids), "states": checked.states, "seconds to check": round(checked.seconds),
        "overtakes read": len(read), "overtakes found": len(known), **dict(sorted(counts.items())),
        "largest difference of DA (m)": round(max(apart, default=0.0), 3),
        "SUMO's own contacts read": len(touched), "SUMO's own contacts found": len(checked.contacts) / 2,
        "contacts shorter as SUMO moves one of them": moved / 2,
    }  # fmt: skip

    chosen = contacts.plants(log, per_kind, seed)
    planted = files._replace(log=folder / "planted.fcd.xml")
    contacts.write(log, chosen, files.log, planted.log)
    found = compare.check(planted, folder / "planted", rules=(compare.COLLISIONS,))
    with_plants = reading.read_log(planted.log, files.routes, net)
    expected = contacts.contacts(with_plants)
    differ += contacts.as_planted(chosen, expected)
    differ += compare.other_contacts(expected, found.contacts, reading.jumps(with_plants), reading.still(with_plants))[
        0
    ]
    return figures | {
        "planted contacts": sum(plant.touches for plant in chosen),
        "planted, missing by 0.1 m": sum(not plant.touches for plant in chosen),
        "contacts found, SUMO's own with them": len(found.contacts) / 2,
        "egos whose contacts are unknown": found.unknown,
    }, differ
