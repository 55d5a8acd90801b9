"""Great Britain: junctions with lights; the arms are 150 m long, the stop lines at 149 m."""

from __future__ import annotations

from tests.outsiders.tenth.actors import flipped
from tests.outsiders.tenth.drive import Drive
from tests.outsiders.tenth.junction import FOUR, Cross

RED = "ukhc.r175.red"
CLEAR = "ukhc.r176.green-exit-clear"
TURN = "ukhc.r180.right-turn-gap"
HOOK = "ukhc.h3.no-cut-across"
LEFT = [(0.0, "left")]
RIGHT = [(0.0, "right")]


def british_lights() -> list[Drive]:
    """With lights: the arms are 150 m long, the stop lines 1 m before the junction at 149."""
    out = []
    c = Cross("gb", FOUR, turn=0.35)
    for a in FOUR:
        c.lights(a)
    d = Drive("gb_lights_bus_on_red_l", c.xml, 22).light("LS", (0, "green"), (5, "amber"), (8, "red"))
    d.ego(c.way("S", "N"), 30, 9.5, cls="bus")
    d.want(RED, "fail", "The bus passes the line when the light has been red for nearly four seconds.")
    out.append(d)

    d = Drive("gb_lights_amber_too_near_l", c.xml, 20).light("LS", (0, "green"), (8.6, "amber"), (11.6, "red"))
    d.ego(c.way("S", "N"), 40, 11.0)
    d.want(RED, "pass", "The light is amber when the front passes the line.")
    out.append(d)

    d = Drive("gb_lights_waits_and_goes_l", c.xml, 34).light("LS", (0, "red"), (16, "red_amber"), (18, "green"))
    d.ego(c.way("S", "N"), 66.5, [(0, 10), (5.5, 10), (10.5, 0), (18.8, 0), (24.0, 8.0)])
    d.add("x", "car", c.way("W", "E"), 20, 9.0).add("y", "van", c.way("E", "W"), 5, 9.0)
    d.want(RED, "pass", "It waits before the line for green.")
    d.want("performance.precise-stop", "pass", "Its front stands 0.3 m before the line.")
    out.append(d)

    d = Drive("gb_lights_stands_in_junction_behind_queue_l", c.xml, 40).light("LS", (0, "green"), (25, "red"))
    d.ego(c.way("S", "N"), 70, [(0, 9), (6, 9), (12, 1.5), (14, 0), (28, 0), (32, 6)])
    d.add("l1", "van", c.way("S", "N"), 167.3, [(0, 0), (27, 0), (31, 6)])
    d.add("l2", "truck", c.way("S", "N"), 179, [(0, 0), (26, 0), (30, 6)])
    d.want(CLEAR, "fail", "It goes in on green with no room beyond and stands in the junction for 14 s.")
    out.append(d)

    d = Drive("gb_lights_right_before_oncoming_l", c.xml, 24).light("LS", (0, "green")).light("LN", (0, "green"))
    d.ego(c.way("S", "E"), 70, [(0, 9), (6, 9), (8.0, 6.0), (24, 6.0)], lamps=RIGHT)
    d.add("on", "car", c.way("N", "S"), 8, 11.7)
    d.want(TURN, "fail", "It turns across a car that is on the place a second later.")
    out.append(d)

    d = Drive("gb_lights_right_makes_oncoming_brake_l", c.xml, 26).light("LS", (0, "green")).light("LN", (0, "green"))
    d.ego(c.way("S", "E"), 70, [(0, 9), (6, 9), (8.0, 6.0), (26, 6.0)], lamps=RIGHT, change=flipped)
    d.add("on", "van", c.way("N", "S"), 22, [(0, 11.5), (9.2, 11.5), (11.0, 3.0), (13.5, 3.0), (17, 10)])
    d.want(
        TURN,
        "not pass",
        "The oncoming van brakes at nearly 5 m/s2 to let it turn; its own heading is recorded backwards.",
    )
    out.append(d)

    d = Drive("gb_lights_right_waits_in_the_middle_l", c.xml, 36).light("LS", (0, "green")).light("LN", (0, "green"))
    d.ego(c.way("S", "E"), 82, [(0, 8.5), (5, 8.5), (11.3, 0), (20.5, 0), (24.5, 6)], lamps=RIGHT)
    for i in range(4):
        d.add(f"on{i}", "car", c.way("N", "S"), 100 - 32 * i, 11.0)
    d.want(TURN, "pass", "It waits in the middle until four cars have passed.")
    d.want(CLEAR, "not fail", "It stands in the junction for those who come towards it, not behind somebody.")
    out.append(d)

    d = Drive("gb_lights_left_over_cyclist_l", c.xml, 22).light("LS", (0, "green"))
    d.ego(c.way("S", "W"), 66, [(0, 10.5), (6.2, 10.5), (8.6, 6.5), (22, 6)], lamps=LEFT)
    d.add("b", "bicycle", c.way("S", "N"), 92, 5.7, 1.35)
    d.want(HOOK, "fail", "It turns left across a cyclist beside it who goes ahead.")
    d.want("ukhc.r182.no-pass-before-turn", "fail", "It gets ahead of the cyclist in the seconds before it turns.")
    d.want("comfort.lateral", "fail", "It takes a bend of 10 m radius at 6.4 m/s, which is 4 m/s2.")
    out.append(d)
    return out
