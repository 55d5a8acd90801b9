"""The paper's three overtakes: at the speed of its logs (5.22 m/s) and at the 25 mph that its text names.

The ego comes up behind a car parked at the kerb of a two-lane road, signals, pulls out, passes and moves back in. Another
car comes the other way, as fast. Only one thing differs between the three: how far away that car is when the ego leaves
its lane. At the logs' speed that is what the paper measured; at any other speed it is as far between what the profiles ask
for as it was there, so that the nine verdicts of the paper's Table 1 stay.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

from drivelint.engine.profiles import Profile, load_profiles
from tests.demo.actors import Actor, car
from tests.demo.line import straight
from tests.demo.road import LANE_WIDTH_M, MPH, Road
from tests.demo.scene import Scene, lane_departure, place_oncoming

PROFILES: Final = ("relaxed", "nominal", "aggressive")
"""The profiles of the paper's Table 1."""
PAPER_SPEED_MPS: Final = 5.22
PAPER_DISTANCES_AHEAD_M: Final = {"safe": 76.43, "near-miss": 58.33, "collision": 35.63}
"""Distance ahead in the paper's logs when the ego leaves its lane."""
ROAD: Final = Road((straight(400.0),))
ROAD_NAME: Final = "overtake-road"
LEAD_IN_S: Final = 7.0  # from the start to pulling out; six of them signalled


class OvertakeManner(NamedTuple):
    """How the ego overtakes: speed, distance of a lane change, where it begins them beside the parked car's middle."""

    speed_mps: float
    change_m: float
    out_m: float
    in_m: float


OVERTAKE_MANNERS: Final = {
    "": OvertakeManner(PAPER_SPEED_MPS, 15.7, -19.5, 4.0),
    "-25mph": OvertakeManner(25 * MPH, 23.5, -29.5, -1.5),
}


def overtakes() -> tuple[Scene, ...]:
    """Return the six scenes, those at the logs' speed first."""
    return tuple(
        _scene(run, ending, manner) for ending, manner in OVERTAKE_MANNERS.items() for run in PAPER_DISTANCES_AHEAD_M
    )


def pass_parked_car(parked_at: float, manner: OvertakeManner) -> tuple[Actor, Actor, float]:
    """Return the ego, the car parked at a station that it passes in this manner, and how long that takes."""
    out, back, v = parked_at + manner.out_m, parked_at + manner.in_m, manner.speed_mps
    ego = (
        car()
        .starts(out - LEAD_IN_S * v)
        .drives(v)
        .moves_out(LANE_WIDTH_M, at=out, within=manner.change_m)
        .moves_in(LANE_WIDTH_M, at=back, within=manner.change_m)
    )
    over = LEAD_IN_S + manner.change_m / v
    home = LEAD_IN_S + (back + manner.change_m - out) / v
    ego = ego.signals("offside", 1.0, over).signals("nearside", over, home)
    return ego, car().starts(parked_at, nearside_m=0.6), math.ceil(home + 3.0)


def _scene(run: str, ending: str, manner: OvertakeManner) -> Scene:
    v = manner.speed_mps
    ahead_m = distance_ahead_m(run, v)
    ego, parked, duration = pass_parked_car(150.0, manner)
    other = place_oncoming(car().drives(v), lane_departure(ego, ROAD, duration), ahead_m=ahead_m)
    shows = f"The paper's {run} overtake at {v / MPH:.0f} mph: the oncoming car is {ahead_m:.2f} m ahead when the ego leaves its lane."
    return Scene(f"{run}{ending}", shows, ROAD, ego, (parked, other), duration, ROAD_NAME)


def distance_ahead_m(run: str, v_mps: float) -> float:
    """Return the distance ahead (m) at which a run at another speed has the same verdicts as in the paper.

    It lies as far between the distances that two neighbouring profiles ask for at this speed as the paper's lies between
    those at the logs' speed; below the least of them it is the same share of it.
    """
    there, here = (sorted(safe_distance_ahead_m(p, v) for p in _profiles()) for v in (PAPER_SPEED_MPS, v_mps))
    there, here = [0.0, *there], [0.0, *here]
    k = next(k for k, asked in enumerate(there) if asked >= PAPER_DISTANCES_AHEAD_M[run])
    share = (PAPER_DISTANCES_AHEAD_M[run] - there[k - 1]) / (there[k] - there[k - 1])
    return here[k - 1] + share * (here[k] - here[k - 1])


def _profiles() -> list[Profile]:
    shipped = load_profiles()
    return [shipped[name] for name in PROFILES]


def safe_distance_ahead_m(profile: Profile, v_mps: float, length_m: float = 4.8) -> float:
    """Return the safe distance ahead (m) by the paper's Appendix A, for equal cars and one parked car."""
    beta, theta = math.radians(profile.pull_out_angle_deg or 0.0), math.radians(profile.cut_in_angle_deg or 0.0)
    gaps = (profile.pull_out_headroom_m or 0.0) + (profile.cut_in_clearance_m or 0.0)
    out_s, in_s = (LANE_WIDTH_M / (v_mps * math.sin(angle)) for angle in (beta, theta))
    passing_s = (gaps + 2 * length_m - v_mps * math.cos(beta) * out_s) / v_mps
    mph = v_mps / MPH
    stopping = 0.300 * mph + 0.058 - 0.011 * mph + 0.015 * mph**2
    own = LANE_WIDTH_M / math.tan(beta) + v_mps * passing_s + LANE_WIDTH_M / math.tan(theta)
    return own + stopping + v_mps * (out_s + passing_s + in_s)
