"""The library of small scenes: each shows one thing. Rules and derivations are tried on them."""

from __future__ import annotations

from typing import Final

from tests.demo.actors import Actor, car, cyclist
from tests.demo.fork import Fork, ForkedRoad
from tests.demo.levels import level_scenes
from tests.demo.line import left, right, straight
from tests.demo.overtakes import OvertakeManner, overtakes, pass_parked_car
from tests.demo.road import LANE_WIDTH_M, MPH, Road, Sign
from tests.demo.scene import Scene, lane_departure, place_oncoming

TWO_LANE_ROAD: Final = Road((straight(500.0),), lanes=2)
LONG_ROAD: Final = Road((straight(1000.0),))
BEND_ROAD: Final = Road((straight(100.0), left(250.0, radius=150.0), straight(150.0)))
SIDE_ROAD: Final = ForkedRoad(
    (straight(600.0),), fork=Fork(at=150.0, through_m=20.0, turn=left(15.707963, radius=10.0), branch=(straight(60.0),))
)
EXIT_ROAD: Final = ForkedRoad(
    (straight(600.0),),
    kind="rural",
    limits_mph=((0.0, 40.0),),
    beside="shoulder",
    signs=(Sign("exit", 100.0), Sign("exit", 200.0)),
    fork=Fork(
        at=350.0,
        through_m=30.0,
        turn=left(30.0, radius=300.0),
        branch=(left(60.0, radius=300.0), straight(120.0)),
        exit_m=120.0,
    ),
)
COUNTRY_ROAD: Final = Road(
    (straight(300.0), left(150.0, radius=120.0), straight(150.0), right(120.0, radius=200.0), straight(400.0)),
    kind="rural",
    limits_mph=((0.0, 30.0), (450.0, 40.0)),
    beside="shoulder",
)


GENTLE_OVERTAKE: Final = OvertakeManner(25 * MPH, 30.0, -40.0, 6.0)


def all_scenes() -> tuple[Scene, ...]:
    """Return every scene, the paper's overtakes first."""
    return (
        *overtakes(),
        *_lane_changes(),
        *_exits(),
        *_harder_overtakes(),
        *_cyclists(),
        *level_scenes(),
        _clean_drive(),
    )


def _lane_changes() -> list[Scene]:
    """Return a change from the nearside lane to the next, crossing the line 11.6 s after the start, signalled this way and that."""
    v, out = 13.0, 10.0 + 13.0 * 10.8
    still = car().starts(10.0, lane=2).drives(v)
    ego = still.moves_out(LANE_WIDTH_M, at=out, within=45.0)
    said = {
        "correct": (ego.signals("offside", 5.5, 14.3), "signalled for six seconds before the line is crossed"),
        "late": (ego.signals("offside", 9.6, 14.3), "signalled two seconds before the line is crossed"),
        "missing": (ego, "not signalled"),
        "intermittent": (
            ego.signals("offside", 5.5, 8.0).signals("offside", 8.8, 14.3),
            "signalled in time, but the indicator is off for most of a second in between",
        ),
        "early": (ego.signals("offside", 1.0, 14.3), "signalled ten and a half seconds before the line is crossed"),
    }
    scenes = [
        Scene(f"signal-{name}", f"A lane change, {how}.", TWO_LANE_ROAD, who, (), 18.0, "two-lane-road")
        for name, (who, how) in said.items()
    ]
    spurious = still.signals("offside", 4.0, 9.0)
    shows = "The ego signals to the offside for five seconds and stays in its lane."
    return [*scenes, Scene("signal-spurious", shows, TWO_LANE_ROAD, spurious, (), 18.0, "two-lane-road")]


def _exits() -> list[Scene]:
    """Return drives past an exit, whose last sign stands at 200 m and whose lane is crossed into at 285 m."""
    v = 15.0
    on = car().starts(20.0).drives(v)
    off = on.moves_in(LANE_WIDTH_M, at=272.0, within=55.0).leaves_by_the_fork()

    def at(station: float) -> float:
        return (station - 20.0) / v

    said = {
        "signalled": (
            off.signals("nearside", at(150.0), at(345.0)),
            "The ego signals before the last exit sign and leaves.",
        ),
        "omitted": (
            off.signals("nearside", at(204.0), at(345.0)),
            "The ego leaves, signalling in time before the line but only after the last exit sign.",
        ),
        "spurious": (
            on.signals("nearside", at(150.0), at(340.0)),
            "The ego signals to leave beside the exit, and drives on.",
        ),
        "not-taken": (on, "The ego drives past the exit without a signal."),
    }
    return [Scene(f"exit-{name}", shows, EXIT_ROAD, who, (), 26.0, "exit-road") for name, (who, shows) in said.items()]


def _harder_overtakes() -> list[Scene]:
    return [
        _with_oncoming(
            "overtake-on-bend",
            "A parked car is passed on a bend of 150 m radius, with room for every profile.",
            BEND_ROAD,
            190.0,
        ),
        _with_oncoming(
            "overtake-at-junction",
            "A parked car is passed in front of a side road, moving back in within the junction, with room for every profile.",
            SIDE_ROAD,
            142.0,
        ),
        _aborted(),
        *_two_in_one_go(),
    ]


def _with_oncoming(name: str, shows: str, road: Road, parked_at: float) -> Scene:
    """Return a gentle overtake at 25 mph, with the oncoming car further away than any profile asks for."""
    ego, parked, duration = pass_parked_car(parked_at, GENTLE_OVERTAKE)
    other = place_oncoming(car().drives(GENTLE_OVERTAKE.speed_mps), lane_departure(ego, road, duration), ahead_m=200.0)
    return Scene(name, shows, road, ego, (parked, other), duration)


def _aborted() -> Scene:
    """Return an overtake given up: at 25 mph the ego is half over the line, sees that it is too late, brakes and falls in behind."""
    ego = (
        car()
        .starts(100.0)
        .drives(25 * MPH)
        .then_drives(5.0, at_s=6.5, rate=3.0)
        .moves_out(2.4, at=156.0, within=20.0)
        .moves_in(2.4, at=178.0, within=18.0)
        .signals("offside", 0.5, 7.0)
        .signals("nearside", 7.0, 10.5)
    )
    slow = car().starts(160.0).drives(6.0)
    other = place_oncoming(car().drives(25 * MPH), lane_departure(ego, LONG_ROAD, 20.0), ahead_m=100.0)
    shows = "An overtake is given up: the ego pulls out with too little road ahead, brakes, and falls in behind again."
    return Scene("overtake-aborted", shows, LONG_ROAD, ego, (slow, other), 20.0, "long-road")


def _two_in_one_go() -> list[Scene]:
    """Return two slow cars passed in one go, at 29 mph, with nobody and with somebody coming the other way."""
    ego = (
        car()
        .starts(20.0)
        .drives(29 * MPH)
        .moves_out(LANE_WIDTH_M, at=86.0, within=35.0)
        .moves_in(LANE_WIDTH_M, at=200.0, within=35.0)
        .signals("offside", 0.1, 7.8)
        .signals("nearside", 13.9, 16.6)
    )
    slow = tuple(car().starts(at).drives(5.0) for at in (100.0, 118.0))
    other = place_oncoming(car().drives(29 * MPH), lane_departure(ego, LONG_ROAD, 20.0), ahead_m=190.0)
    alone = "Two slow cars are passed in one go, with nobody coming the other way."
    crash = "Two slow cars are passed in one go, with the road ahead that a relaxed driver needs for one of them; it ends in a crash."
    return [
        Scene("overtake-two-in-one-go", alone, LONG_ROAD, ego, slow, 20.0, "long-road"),
        Scene("overtake-two-too-many", crash, LONG_ROAD, ego, (*slow, other), 20.0, "long-road"),
    ]


def _cyclists() -> list[Scene]:
    """Return a cyclist, half a metre from the kerb, passed at 25 mph with this much air between the boxes."""
    rider: Actor = cyclist().starts(90.0, nearside_m=0.95).drives(4.5)
    scenes = []
    for clearance in (1.0, 1.6):
        aside = 0.95 - rider.body.width_m / 2 - car().body.width_m / 2 - clearance
        ego = (
            car()
            .starts(20.0)
            .drives(25 * MPH)
            .moves_out(-aside, at=82.0, within=22.0)
            .moves_in(-aside, at=156.0, within=22.0)
            .signals("offside", 0.5, 7.6)
            .signals("nearside", 11.9, 14.2)
        )
        shows = f"A cyclist is passed with {clearance:.1f} m between the boxes."
        scenes.append(Scene(f"cyclist-at-{clearance:.1f}m", shows, LONG_ROAD, ego, (rider,), 24.0, "long-road"))
    return scenes


def _clean_drive() -> Scene:
    """Return a drive in which nothing is wrong: behind another car, round bends, from a 30 into a 40 mph limit."""

    def faster(actor: Actor, at_s: float) -> Actor:
        return actor.drives(12.0).then_drives(15.0, at_s=at_s, rate=1.0)

    ego, lead = faster(car().starts(120.0), 32.0), faster(car().starts(175.0), 28.0)
    others = tuple(car().starts(at, lane=-1).drives(12.0) for at in (520.0, 880.0))
    shows = "A clean drive: behind another car with room to stop, round bends, into a higher limit, past oncoming cars."
    return Scene("clean-drive", shows, COUNTRY_ROAD, ego, (lead, *others), 42.0)
