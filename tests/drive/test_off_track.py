"""A sample beside its track, and a small step of a track, have no place; no speed is derived from them, and no finding comes of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np
import pytest

from drivelint.drive import outliers
from drivelint.drive.order import steps
from drivelint.drive.trace import States
from tests.ingested import ingested
from tests.scenes import Actor, drive, moving, road, times, verdict_rows

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace
    from drivelint.engine.batch import Drive

WAY: Final = road(((2000.0, 0.0),), lanes=(1, 2))
RULES: Final = (
    "ukhc.contact-signature",
    "ukhc.r143.direction",
    "ukhc.r124.speed-limit",
    "ukhc.no-collision",
    "comfort",
    "criticality",
)
SPEED: Final = 10.0


def scene(kind: str, hz: float, actor_id: str, *, with_velocity: bool, noise_m: float = 0.0) -> tuple[Drive, int]:
    """Return two vehicles abreast, 0.4 m apart, at 10 m/s, one of them elsewhere from its middle sample on; and that sample's number.

    `kind`: what happens, and how far: `back`, `side` and `jump` for one sample, `stay` for good, `zero` to the origin for good.
    """
    t = times(12.0, period=1.0 / hz)
    k, i = len(t) // 2, np.arange(len(t))
    pair = {
        "ego": moving("ego", WAY, t, 100 + SPEED * t, WAY.ego_d),
        "x": moving("x", WAY, t, 101 + SPEED * t, WAY.ego_d - 2.2),
    }
    if not with_velocity:
        nothing = np.full(len(t), np.nan)
        pair = {name: replace(actor, vx=nothing, vy=nothing) for name, actor in pair.items()}
    actor, rng = pair[actor_id], np.random.default_rng(3)
    x, y = actor.x + rng.normal(0, noise_m, len(t)), actor.y + rng.normal(0, noise_m, len(t))
    what, far = kind.rstrip("0123456789."), float(kind.lstrip("abcdefghijklmnopqrstuvwxyz") or 0)
    if what == "zero":
        x, y = np.where(i >= k, 0.0, x), np.where(i >= k, 0.0, y)
    else:
        there = i >= k if what == "stay" else i == k
        x = x + {"back": -far, "side": 0.0}.get(what, far) * there
        y = y + (far if what == "side" else 0.0) * there
    pair[actor_id] = replace(actor, x=x, y=y)
    return ingested(drive(pair.values(), WAY.environment, drive_id=f"{kind}/{hz:g}/{actor_id}/{with_velocity}")), k


def states(trace: Trace, actor_id: str) -> list[dict[str, float | None]]:
    rows = [row for row in trace.tables["actor_state"].to_pylist() if row["actor_id"].split("#")[0] == actor_id]
    return sorted(rows, key=lambda row: row["t_ns"])


def wrong_speeds(trace: Trace, actor_id: str) -> list[tuple[int, float, float]]:
    """Return the states that move at another velocity than everybody does, with 0.6 m/s of tolerance; who stands at the origin does."""
    return [
        (i, row["vx_mps"], row["vy_mps"] or 0.0)
        for i, row in enumerate(states(trace, actor_id))
        if row["vx_mps"] is not None
        and row["x_m"] != 0.0
        and np.hypot(row["vx_mps"] - SPEED, row["vy_mps"] or 0.0) > 0.6
    ]


def teleports(trace: Trace) -> list[int]:
    return [row["n"] for row in trace.tables["quality"].to_pylist() if row["check_id"] == "teleport"]


BACK_STEPS: Final = [
    *((kind, hz) for kind in ("back0.5", "back1", "back3", "side0.5", "side2") for hz in (10, 20)),
    *((kind, 2) for kind in ("back2", "back3", "side2")),
]


@pytest.mark.parametrize("with_velocity", [True, False])
@pytest.mark.parametrize(("kind", "hz"), BACK_STEPS)
def test_a_sample_beside_its_track_has_no_place_and_its_neighbours_no_speed_from_it(
    kind: str, hz: float, with_velocity: bool
) -> None:
    for actor_id in ("ego", "x"):
        scenery, k = scene(kind, hz, actor_id, with_velocity=with_velocity)
        assert [i for i, row in enumerate(states(scenery.trace, actor_id)) if row["x_m"] is None] == [k]
        assert not wrong_speeds(scenery.trace, actor_id)
        assert teleports(scenery.trace) == [1]


@pytest.mark.parametrize("with_velocity", [True, False])
@pytest.mark.parametrize("hz", [2, 10, 20])
@pytest.mark.parametrize("kind", ["jump5", "jump60", "stay5", "stay60", "zero"])
def test_a_jump_has_no_place_and_no_speed(kind: str, hz: float, with_velocity: bool) -> None:
    for actor_id in ("ego", "x"):
        scenery, k = scene(kind, hz, actor_id, with_velocity=with_velocity)
        found = states(scenery.trace, actor_id)
        assert found[k]["x_m"] is None
        assert not wrong_speeds(scenery.trace, actor_id)
        said = {row["check_id"] for row in scenery.trace.tables["quality"].to_pylist()}
        assert said & {"teleport", "motion_unknown"}


@pytest.mark.parametrize(("hz", "far"), [(10, 0.5), (10, 2.0), (20, 0.3)])
def test_a_small_step_of_a_track_for_good_gives_no_speed(hz: float, far: float) -> None:
    """Where velocities are recorded it is what maps and filters do, and nothing hangs on it."""
    scenery, k = scene(f"stay{far}", hz, "x", with_velocity=False)
    assert [i for i, row in enumerate(states(scenery.trace, "x")) if row["x_m"] is None] == [k - 1, k]
    assert not wrong_speeds(scenery.trace, "x")
    if far < 1.0:
        scenery, _ = scene(f"stay{far}", hz, "x", with_velocity=True)
        assert not teleports(scenery.trace)


@pytest.mark.parametrize("kind", ["none0", "back1", "back2", "stay2"])
def test_noise_hides_no_back_step_and_is_none(kind: str) -> None:
    """With 5 cm of noise; the filter goes on over the one sample that has no place."""
    scenery, k = scene(kind.replace("none", "jump"), 10, "x", with_velocity=False, noise_m=0.05)
    lost = [i for i, row in enumerate(states(scenery.trace, "x")) if row["x_m"] is None]
    assert lost == {"n": [], "b": [k], "s": [k - 1, k]}[kind[0]]
    assert not wrong_speeds(scenery.trace, "x")
    if kind != "stay2":
        assert all(row["vx_mps"] is not None for row in states(scenery.trace, "x")[10:-10] if row["x_m"] is not None)


def test_noise_and_hard_manoeuvres_are_on_their_track() -> None:
    t, rng = times(30.0), np.random.default_rng(5)
    actors = [moving("ego", WAY, t, 100 + SPEED * t, WAY.ego_d)]
    for number, sigma in enumerate((0.0, 0.02, 0.1, 0.2)):
        v = np.clip(15 + np.cumsum(np.repeat(rng.uniform(-9, 9, 31), 10)[: len(t)]) * 0.1, 0.0, 25.0)
        actor = moving(f"a{number}", WAY, t, 200 + np.cumsum(v) * 0.1, WAY.ego_d + np.sin(t))
        actors.append(
            replace(actor, x=actor.x + rng.normal(0, sigma, len(t)), y=actor.y + rng.normal(0, sigma, len(t)))
        )
    nothing = np.full(len(t), np.nan)
    without = [replace(actor, vx=nothing, vy=nothing) for actor in actors]
    for each in (actors, without):
        assert not teleports(ingested(drive(each, WAY.environment)).trace)


@pytest.mark.parametrize("with_velocity", [True, False])
def test_an_impact_is_no_back_step(with_velocity: bool) -> None:
    """From one sample to the next the ego is struck: it has another speed from there on, and for one sample more of it.

    The last is a standing vehicle of cav_loop into which somebody walks.
    """
    t = times(10.0)
    for speeds in ((10.0, 2.0, 2.0), (0.0, 5.0, 3.0), (10.0, -2.0, 0.0), (0.4, 4.6, 2.6)):
        v = np.select([t < 4.95, t < 5.05], speeds[:2], speeds[2])
        x = 200 + np.r_[0.0, np.cumsum(v[:-1]) * 0.1]
        struck: Actor = replace(moving("ego", WAY, t, x, WAY.ego_d), vx=v if with_velocity else np.full(len(t), np.nan))
        struck = replace(struck, vy=struck.vx * 0.0, yaw=np.zeros(len(t)))
        trace = ingested(drive([struck], WAY.environment)).trace
        assert all(row["x_m"] is not None for row in states(trace, "ego"))
        fastest = np.diff([row["vx_mps"] for row in states(trace, "ego")])
        assert np.nanmax(np.abs(fastest)) > 1.2


@pytest.mark.slow
def test_no_finding_comes_of_a_jump() -> None:
    """The ego jumps, or the one beside it: no rule is broken by that."""
    grid = [(kind, 10) for kind in ("back1", "back3", "side0.5", "jump20", "stay0.5", "zero")] + [
        ("back0.5", 20),
        ("jump60", 2),
    ]
    drives = [scene(kind, hz, actor_id, with_velocity=False)[0] for kind, hz in grid for actor_id in ("ego", "x")]
    drives += [
        scene(kind, 10, actor_id, with_velocity=True)[0] for kind in ("side0.5", "jump20") for actor_id in ("ego", "x")
    ]
    found = verdict_rows(drives, rules=RULES)
    assert not [(row["drive_id"], row["rule_id"], row["reason"]) for row in found if row["verdict"] == "fail"]
    # and each says why it does not know
    unknown = {
        row["drive_id"] for row in found if row["rule_id"] == "ukhc.contact-signature" and row["verdict"] == "unknown"
    }
    assert {one.trace.drive_id for one in drives if teleports(one.trace)} <= unknown


@pytest.mark.parametrize("with_velocity", [True, False])
@pytest.mark.parametrize("piece_rows", [1, 7, 100])
def test_pieces_do_not_decide(piece_rows: int, monkeypatch: pytest.MonkeyPatch, *, with_velocity: bool) -> None:
    """A long drive is looked at in pieces: a sample at the edge of one is as in the middle."""
    rng = np.random.default_rng(7)
    t_ns = np.tile(np.arange(150) * 100_000_000, 2)
    x = t_ns * 1e-8 + np.where(rng.random(300) < 0.1, rng.normal(0, 2.0, 300), 0.0)
    y = np.where(rng.random(300) < 0.02, np.nan, 0.0)
    speed = np.full(300, 10.0 if with_velocity else np.nan)
    numbers = {"x_m": x, "y_m": y, "vx_mps": speed, "vy_mps": 0 * speed}
    states = States(["a", "b"], np.repeat([0, 1], 150).astype(np.int32), t_ns, numbers, {}, np.zeros(300, np.bool_))
    usual = outliers.outlier_samples(states, steps(states))
    assert usual.any()
    monkeypatch.setattr(outliers, "PIECE_ROWS", piece_rows)
    assert (outliers.outlier_samples(states, steps(states)) == usual).all()
