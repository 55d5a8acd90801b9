"""Great Britain: crossings with lights."""

from __future__ import annotations

from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.streets import pelican

PEL = "ukhc.r196.pelican"
STR = "ukhc.r198.still-crossing"
RED = "ukhc.r175.red"


def british_signalled_crossings() -> list[Drive]:
    """Crossings with lights."""
    out = []
    s = pelican((0.0, 0.0, 0.5))
    d = Drive("gb_pelican_red_for_two_seconds_l", s.xml, 18).light("P0", (0, "green"), (5.5, "amber"), (8.5, "red"))
    d.ego(s.way(1), 32, 10.6)
    d.add("w", "pedestrian", s.walk(150, -5, 5), 0, [(0, 0), (12.5, 0), (13, 1.4)])
    d.want(RED, "fail", "The light has been red for nearly two seconds when the front passes the line.")
    d.want(PEL, "fail", "It goes onto the signalled crossing on red.")
    out.append(d)

    s = pelican((0.0, 0.0, -0.5))
    d = Drive("gb_pelican_flashing_amber_walker_on_l", s.xml, 22).light(
        "P0", (0, "red"), (8.0, "flashing"), (14, "green")
    )
    d.ego(s.way(1), 75, [(0, 8.0), (5.6, 8.0), (8.6, 3.0), (9.4, 3.0), (13.0, 8.0)])
    d.add("w", "pedestrian", s.walk(150, -5, 5), 0, [(0, 0), (4.9, 0), (5.3, 1.3)])
    d.want(PEL, "fail", "Amber flashes and a walker is on the ego's half.")
    out.append(d)

    s = pelican((10.0, 0.0, -2.5))
    d = Drive("gb_pelican_flashing_amber_all_gone_l", s.xml, 24).light(
        "P0", (0, "red"), (9.0, "flashing"), (16, "green")
    )
    d.ego(s.way(1), 70, [(0, 8.0), (6.9, 8.0), (11.3, 0.0), (12.5, 0.0), (16.0, 7.0)])
    d.add("w", "pedestrian", s.walk(150, 4.5, -9), 0, [(0, 0), (4.0, 0), (4.4, 1.5)])
    d.want(PEL, "pass", "The walker is over when it goes on while amber flashes.")
    out.append(d)

    s = pelican((10.0, 0.0, 0.0))
    d = Drive("gb_pelican_green_old_man_still_on_l", s.xml, 20).light(
        "P0", (0, "red"), (4.0, "flashing"), (7.5, "green")
    )
    d.ego(s.way(1), 44, 9.0, -0.3)
    d.add("w", "pedestrian", s.walk(149.4, -5, 5.5), 0, [(0, 0), (0.8, 0), (1.2, 0.75)])
    d.want(STR, "fail", "The light is green, but an old man is still on the ego's half.")
    d.want(RED, "pass", "The light is green.")
    out.append(d)

    s = pelican((0.0, 50.0, 1.5))
    d = Drive("gb_pelican_goes_on_red_and_amber_l", s.xml, 22).light(
        "P0", (0, "red"), (12.0, "red_amber"), (15.5, "green")
    )
    d.ego(s.way(1), 70, [(0, 8.0), (7.1, 8.0), (11.1, 0.0), (12.6, 0.0), (16.0, 6.0)])
    d.want(RED, "fail", "Its front passes the line while red and amber are lit.")
    out.append(d)

    s = pelican((0.0, 50.0, 2.5), heads=2)
    d = Drive("gb_pelican_two_heads_disagree_l", s.xml, 18)
    d.light("P0", (0, "green")).light("P1", (0, "red"))
    d.ego(s.way(1), 40, 10.0)
    d.want(RED, "not pass", "Of the two heads of one line one is green and one is red.")
    out.append(d)

    s = pelican((0.0, 50.0, -2.5))
    d = Drive("gb_pelican_states_end_early_l", s.xml, 20).light("P0", (0, "green"))
    d.lights = [x for x in d.lights if x[1] < 3.6]
    d.ego(s.way(1), 20, 9.0)
    d.want(RED, "not fail", "The states end ten seconds before the ego gets there; what the light shows is not known.")
    d.want(PEL, "not fail", "Nor whether the light lets it over the crossing.")
    out.append(d)

    s = pelican((0.0, 50.0, -1.5))
    d = Drive("gb_pelican_stands_on_green_before_walker_l", s.xml, 24).light("P0", (0, "red"), (7.0, "green"))
    d.ego(s.way(1), 69, [(0, 8.0), (6.9, 8.0), (11.3, 0.0), (15.0, 0.0), (18.0, 6.0)])
    d.add("w", "pedestrian", s.walk(150, -4.5, 5.5), 0, [(0, 0), (6.0, 0), (6.4, 1.3)])
    d.want(STR, "pass", "It waits on green until the walker is over.")
    d.want(
        "performance.precise-stop", "not fail", "It stands before the line on green, for a walker and not for the line."
    )
    out.append(d)
    return out
