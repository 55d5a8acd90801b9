"""Great Britain: motorways, shoulders, exits, stopping and the wrong way."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import beside, british_motorway


def british_motorways() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_m_shoulder_past_queue_h",
        "The ego passes a queue on the hard shoulder.",
        "fail r269.hard-shoulder | pass no-collision",
        british_motorway(),
        25,
    )
    for i in range(6):
        d.add(f"q{i}", s=120 + 14 * i, v=1.5, u=beside(4))
    d.add("ego", s=20, v=[(0, 20), (25, 20)], u=[(1, beside(4)), (4, beside(5))])

    d = chapter.draw(
        "gb_m_breakdown_h",
        "The ego breaks down, warns and stops on the hard shoulder.",
        "not fail r269.hard-shoulder r240.no-stopping",
        british_motorway(),
        40,
    )
    d.add("ego", s=30, v=[(0, 27), (3, 27), (16, 0), (40, 0)], u=[(4, beside(4)), (9, beside(5))], ind=[(2, "hazard")])

    d = chapter.draw(
        "gb_m_stop_in_lane_h",
        "The ego stops for a quarter of a minute on a free motorway.",
        "fail r240.no-stopping | pass r116.hazards",
        british_motorway(),
        35,
    )
    d.add("ego", s=30, v=[(0, 25), (2, 25), (14, 0), (30, 0), (35, 6)], u=beside(4))
    d.add("pass", s=-90, v=30, u=beside(3))

    d = chapter.draw(
        "gb_m_reverse_to_exit_h",
        "The ego stops on the motorway and reverses.",
        "fail r263.no-reverse r143.direction | not pass declared.r202.checks-before-reversing",
        british_motorway(),
        30,
    )
    d.add("ego", s=300, v=[(0, 18), (9, 0), (12, 0), (14, -3.5), (24, -3.5), (27, 0)], u=beside(4))

    d = chapter.draw(
        "gb_m_ghost_driver_h",
        "The ego drives on the motorway against the traffic; another swerves.",
        "fail r143.direction | pass no-collision | not pass rss.opposite",
        british_motorway(length=1200),
        18,
    )
    d.add("ego", s=1150, v=26, u=beside(2), against=True).add("vic", s=300, v=30, u=[(9, beside(2)), (11.5, beside(3))])

    d = chapter.draw(
        "gb_m_other_ghost_h",
        "Somebody comes the wrong way and the ego changes lane in time.",
        "pass r143.direction no-collision",
        british_motorway(length=1200),
        18,
    )
    d.add("ghost", s=1150, v=26, u=beside(2), against=True).add(
        "ego", s=300, v=29, u=[(6, beside(2)), (9, beside(3))], ind=[(4, "left"), (9, "off")]
    )

    d = chapter.draw(
        "gb_m_exit_silent_h",
        "The ego leaves the motorway without a signal.",
        "fail exit-sign-signal",
        british_motorway(slip=(350, 700, "exit")),
        30,
    )
    d.map["1"].signal("ex1", 352, 4, "333", "de", "exit", out=7.0)
    d.add("ego", s=30, v=[(0, 27), (16, 27), (30, 20)], u=[(13, beside(4)), (18, beside(5, 4))])

    d = chapter.draw(
        "gb_m_exit_signalled_h",
        "The ego leaves the motorway and has signalled in good time.",
        "pass exit-sign-signal | not fail signal-then-leaves",
        british_motorway(slip=(350, 700, "exit")),
        30,
    )
    d.map["1"].signal("ex1", 352, 4, "333", "de", "exit", out=7.0)
    d.add(
        "ego",
        s=30,
        v=[(0, 27), (16, 27), (30, 20)],
        u=[(14, beside(4)), (18.5, beside(5, 4))],
        ind=[(9, "left"), (20, "off")],
    )

    d = chapter.draw(
        "gb_m_signal_but_stays_h",
        "The ego signals beside an exit lane and stays on the motorway.",
        "fail signal-then-leaves | not fail exit-sign-signal",
        british_motorway(slip=(300, 640, "exit")),
        32,
    )
    d.map["1"].signal("ex1", 302, 4, "333", "de", "exit", out=7.0)
    d.add("ego", s=30, v=27, u=beside(4), ind=[(10, "left"), (25, "off")])

    d = chapter.draw(
        "gb_m_night_dark_h",
        "The ego drives on a motorway at night without headlights.",
        "fail r113.headlights | not fail r115.dipped-headlights",
        british_motorway(),
        20,
        light="night",
    )
    d.add("ego", s=30, v=28, u=beside(4)).says(0, "headlights", "off").says(15, "headlights", "on")

    d = chapter.draw(
        "gb_m_hazards_cruise_h",
        "The ego drives on a free motorway with its hazard lights on.",
        "not pass r116.hazards",
        british_motorway(),
        20,
    )
    d.add("ego", s=30, v=28, u=beside(4), ind="hazard")

    d = chapter.draw(
        "gb_dual_hazards_h",
        "The ego drives with hazard lights on a dual carriageway in a town.",
        "fail r116.hazards | pass r124.speed-limit",
        british_motorway(lanes=2, speed=40, shoulder=False, kind="town"),
        20,
    )
    d.add("ego", s=30, v=16, u=beside(3), ind=[(4, "hazard"), (15, "off")])

    d = chapter.draw(
        "gb_m_pedestrian_on_lane_h",
        "The ego stops on the motorway for a man who walks across it.",
        "pass no-collision | not fail r240.no-stopping",
        british_motorway(),
        25,
    )
    d.add("ego", s=100, v=[(0, 28), (3, 28), (9.5, 0), (20, 0), (25, 8)], u=beside(4))
    d.walk("man", [(0, 295, 16), (8, 295, 14), (14, 295, 6), (19, 295, -3)])
    return chapter.drives
