"""Great Britain: motorways, following and lanes."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.faults import jolt
from tests.outsiders.sixth.maps import beside, british_motorway


def british_following() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_m_tailgate_h",
        "The ego follows a car on the motorway at 68 mph, 12 m behind it.",
        "fail r126.thinking-gap criticality.thw | pass r124.speed-limit no-collision",
        british_motorway(),
        20,
    )
    d.add("ego", s=60, v=30.2, u=beside(2)).add("lead", s=60 + 4.5 + 12.5, v=30.2, u=beside(2))
    d.add("lorry", s=220, v=24, u=beside(4), cls="truck")

    d = chapter.draw(
        "gb_m_steady_h",
        "The ego follows a car on the motorway, more than two seconds behind it, past lorries.",
        "pass r126.thinking-gap criticality.thw r269.hard-shoulder r240.no-stopping",
        british_motorway(),
        30,
    )
    d.add("ego", s=10, v=29.0, u=beside(3) + 0.1).add("lead", s=90, v=29.0, u=beside(3))
    d.add("l1", s=300, v=24.5, u=beside(4), cls="truck").add("l2", s=340, v=24.5, u=beside(4), cls="truck")

    d = chapter.draw(
        "gb_m_fast_h",
        "The ego does 85 mph on a motorway of four lanes.",
        "fail r124.speed-limit | pass r131.keep-in-lane",
        british_motorway(lanes=4),
        20,
        hz=25,
    )
    d.add("ego", s=10, v=[(0, 29), (6, 37.5), (20, 38.5)], u=beside(2))

    d = chapter.draw(
        "gb_m_lorry_right_lane_h",
        "A lorry passes another in the right-hand lane of three.",
        "fail r265.right-lane-ban | pass r124.speed-limit",
        british_motorway(),
        25,
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=20, v=24.8, u=beside(2), cls="truck").add("other", s=80, v=22.5, u=beside(3), cls="truck")

    d = chapter.draw(
        "gb_m_lorry_middle_h",
        "A lorry passes another in the middle lane of three.",
        "pass r265.right-lane-ban",
        british_motorway(),
        25,
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=20, v=24.9, u=beside(3), cls="truck").add("other", s=60, v=22.0, u=beside(4), cls="truck")

    d = chapter.draw(
        "gb_m_lorry_two_lanes_h",
        "A lorry passes another in the right-hand lane of two.",
        "not fail r265.right-lane-ban",
        british_motorway(lanes=2),
        20,
        vehicle_class="goods_over_7t5",
    )
    d.add("ego", s=20, v=24.0, u=beside(2), cls="truck").add("other", s=60, v=22.0, u=beside(3), cls="truck")

    d = chapter.draw(
        "gb_m_towing_fast_h",
        "The ego tows a caravan at 67 mph.",
        "fail r124.speed-limit | not fail no-collision",
        british_motorway(),
        22,
        vehicle_class="car_towing",
    )
    d.add("ego", s=30, v=30.0, u=beside(4)).add(
        "caravan", s=30 - 2.25 - 3.2, v=30.0, u=beside(4), cls="trailer", size=(6.0, 2.2, 2.6)
    )

    d = chapter.draw(
        "gb_m_cut_in_restored_h",
        "A van moves in right before the ego, which drops back to two seconds.",
        "pass r168.drop-back no-collision | not fail criticality.thw",
        british_motorway(),
        30,
    )
    d.add("ego", s=60, v=[(0, 29), (4, 29), (8, 24.5), (14, 25), (30, 26.5)], u=beside(3))
    d.add(
        "van",
        s=60 + 4.5 + 2,
        v=[(0, 30), (30, 30)],
        u=[(4, beside(4)), (8, beside(3))],
        cls="van",
        ind=[(3, "right"), (8, "off")],
    )

    d = chapter.draw(
        "gb_m_cut_in_kept_close_h",
        "A van moves in 15 m ahead and the ego stays there.",
        "fail r168.drop-back criticality.thw r126.thinking-gap",
        british_motorway(),
        30,
    )
    d.add("ego", s=60, v=27.2, u=beside(3))
    d.add("van", s=60 + 5.5 + 15, v=27.2, u=[(3, beside(2)), (7, beside(3))], cls="van")

    d = chapter.draw(
        "gb_m_queue_end_crash_h",
        "The ego brakes too late and runs into the end of a queue.",
        "fail no-collision criticality.ttc criticality.drac criticality.ttb",
        british_motorway(),
        20,
    )
    d.add("ego", s=100, v=[(0, 30), (7.5, 30), (9.5, 20), (20, 0)], u=beside(4)).add(
        "tail", s=400, v=2.0, u=beside(4), cls="truck"
    )
    d.add("tail2", s=416, v=2.0, u=beside(4), cls="truck")

    d = chapter.draw(
        "gb_m_astride_h",
        "The ego drives astride a lane line for twenty seconds.",
        "fail r131.keep-in-lane | pass r269.hard-shoulder",
        british_motorway(),
        30,
    )
    d.add("ego", s=30, v=26, u=[(2, beside(4)), (4, beside(4) - 1.75), (24, beside(4) - 1.75), (26, beside(4))])

    d = chapter.draw(
        "gb_m_contact_unseen_h",
        "The ego pushes a car whose recorded box is too small for the contact to be seen.",
        "fail contact-signature r126.thinking-gap",
        british_motorway(),
        15,
    )
    d.add("ego", s=100, v=27, u=beside(3), edit=jolt).add(
        "lead", s=100 + 4.5 + 12.5, v=[(0, 27), (2, 27), (7.9, 23.0), (15, 25)], u=beside(3)
    )

    d = chapter.draw(
        "gb_m_queue_stop_h",
        "The ego stops at the end of a motorway queue.",
        "pass no-collision | not fail r240.no-stopping",
        british_motorway(),
        45,
    )
    d.add("ego", s=30, v=[(0, 24), (2, 24), (14, 1), (16, 0), (36, 0), (42, 6)], u=beside(3))
    d.add("lead", s=30 + 4.5 + 92, v=[(0, 20), (11, 0.5), (13, 0), (34, 0), (40, 7)], u=beside(3), cls="van")
    d.add("side", s=222, v=[(0, 5), (12, 0), (45, 0)], u=beside(4), cls="truck")
    return chapter.drives
