"""What happens in each scene, and its verdicts.

fail: a clear breach; pass: clearly kept with all that is needed there; notfail: what no reasonable person would call a breach;
notpass: what must not be called kept.
"""

from __future__ import annotations

from tests.outsiders.log import Scene

_PACKS = {
    "alks": "alks-r157",
    "comfort": "comfort",
    "crit": "criticality",
    "said": "declared",
    "perf": "performance",
    "rss": "rss",
    "de": "stvo",
    "hc": "ukhc",
}
_VERDICTS = {"fail": "fail", "pass": "pass", "notfail": "not fail", "notpass": "not pass"}

_TOLD = """
de_alks_tailgates: fail: alks.follow-gap crit.thw; notfail: de.rg4
    The engaged ego follows a car at 50 km/h ten metres behind it for 25 s.
de_alks_follows_well: pass: alks.follow-gap crit.thw crit.ttc crit.drac; notfail: comfort.nuplan
    The engaged ego follows a car at 50 km/h thirty metres behind it.
de_alks_cut_in_collision: fail: alks.cut-in hc.no-collision crit.ttc crit.drac crit.ttb
    A slower car moves over for seconds 20 m ahead of the engaged ego, which drives into it unbraked.
de_alks_cut_in_braked: pass: alks.cut-in hc.no-collision; notfail: hc.contact-signature alks.emergency de.rg2
    A slower car moves over 24 m ahead of the engaged ego, which brakes and stays behind it.
de_alks_cut_in_gap_kept_short: fail: alks.cut-in-gap crit.thw
    After a car cut in ten metres ahead at 50 km/h the engaged ego stays ten metres behind for 20 s.
de_alks_emergency_undeclared: fail: alks.emergency de.rg2 comfort.decel-iso15622 comfort.jerk-iso15622 comfort.nuplan
    The engaged ego brakes with up to 7.7 m/s2 on an empty motorway and declares no emergency manoeuvre.
de_alks_emergency_declared: notfail: alks.emergency de.rg2
    The car ahead brakes to a crawl; the engaged ego declares an emergency manoeuvre and brakes as hard.
de_alks_mrm_hard_and_dark: fail: alks.mrm alks.mrm-hazards
    In a minimal risk manoeuvre the ego brakes for 4 s with 5.5 m/s2 and leaves its hazard lights off.
de_alks_mrm_gentle: pass: alks.mrm alks.mrm-hazards
    In a minimal risk manoeuvre the ego slows with at most 3 m/s2 and its hazard lights flash all the time.
de_alks_lane_change_unsignalled: fail: alks.r79.lane-change; pass: alks.r79.lane-change-done
    The engaged ego changes lane without any indicator.
de_alks_lane_change_signalled: pass: alks.r79.lane-change alks.r79.lane-change-done
    The engaged ego signals for four seconds and then changes lane in one move.
de_alks_lane_change_dawdled: fail: alks.r79.lane-change-done
    The engaged ego rides on the line for eight seconds in the middle of its lane change.
de_alks_lane_change_lamp_unknown: notpass: alks.r79.lane-change; notfail: alks.r79.lane-change-done
    The engaged ego changes lane; the log does not know its indicator.
de_mway_tailgate_120: fail: de.rg1 crit.thw rss.longitudinal; notfail: hc.no-collision
    The ego follows at 120 km/h six metres behind a car.
de_mway_follow_half_speedo: pass: de.rg1 crit.thw crit.ttc crit.drac crit.ttb crit.mttc
    The ego follows at 120 km/h with half the speedometer reading in metres.
de_mway_deer: notfail: de.rg2 de.ri1 de.rg4
    The ego brakes to a halt for a deer that walks across the motorway.
de_mway_speeding: fail: de.rg3
    The ego drives 162 km/h where 120 is the limit.
de_mway_crawl: fail: de.rg4
    The ego drives 43 km/h on an empty motorway of 120 km/h for 40 s.
de_mway_cuts_out_before_faster: fail: de.rg6
    The ego at 90 km/h moves out before a car at 160 km/h 30 m behind, which has to brake hard.
de_mway_stops_for_nothing: fail: de.ri1
    The ego stops in its lane on an empty motorway and stands for 15 s.
de_mway_stops_for_queue: pass: de.ri1 crit.ttc; notfail: de.rg2 de.rg4 crit.drac
    The ego slows gently and stops behind a queue.
de_mway_breakdown: notfail: de.ri1 de.rg4 de.rg2
    The ego breaks down, puts its hazard lights on, rolls to the hard shoulder and stands there.
de_mway_undertakes: fail: de.ri2
    The ego passes a car on its right at 120 km/h in free traffic.
de_mway_queue_passed_on_right: notfail: de.ri2
    The ego at 45 km/h rolls past a queue at 36 km/h in the lanes to its left.
de_mway_reverses: fail: de.ri3
    The ego stops past its exit and reverses along the motorway for ten seconds.
de_mway_wrong_way: fail: de.ri3
    The ego drives against the traffic on a motorway.
de_mway_tailgate_heading_turned: notpass: de.rg1 crit.thw
    The ego follows six metres behind at 120 km/h; the log has its heading the wrong way round all along.
de_mway_lorry_30m: fail: de.s4-truck; notfail: de.rg3
    A lorry follows another at 80 km/h and 30 m.
de_mway_lorry_brief_cut_in: notfail: de.s4-truck de.rg1 crit.thw
    A much faster car cuts in 40 m ahead of a lorry and is 60 m away two seconds later.
de_mway_lorry_unknown_kind: notpass: de.s4-truck
    A vehicle of 16 m and unknown class follows another at 80 km/h and 25 m.
de_mway_tailgate_off_the_map: notpass: de.rg1 crit.thw
    The map ends at 300 m; after that the ego comes up to eight metres behind a car at 120 km/h and stays there.
de_cyclist_close_town: fail: de.s5-passing
    The ego overtakes a cyclist in town with 0.8 m to spare.
de_cyclist_wide_town: pass: de.s5-passing; notfail: rss.opposite
    The ego overtakes a cyclist in town with 1.9 m to spare.
de_cyclist_close_rural: fail: de.s5-passing
    The ego overtakes a cyclist on a rural road at 80 km/h with 1.4 m to spare.
de_cyclist_drew_up: notfail: de.s5-passing hc.no-collision hc.contact-signature crit.ttc
    A cyclist draws up close beside the ego that waits in a queue; when it moves, the ego is faster.
de_stop_sign_kept: pass: de.rin1 perf.precise-stop
    The ego halts for four seconds 40 cm before the line of a stop sign.
de_late_braking: fail: crit.ttc crit.drac crit.ttb comfort.nuplan; notfail: hc.no-collision
    The ego at 72 km/h brakes with all it has and comes to stand two metres behind a standing car.
de_gentle_approach: pass: crit.ttc crit.drac crit.ttb; notfail: comfort.decel-iso15622 comfort.jerk-iso15622
    The ego slows from 72 km/h over twelve seconds and stops 5 m behind a standing car.
de_crossing_half_a_second: fail: crit.pet; notfail: hc.no-collision
    The ego crosses a junction 0.6 s after a car from the side road has left its way.
de_overtake_into_oncoming: fail: rss.opposite; notfail: hc.no-collision
    The ego overtakes a tractor and is back 140 m and three seconds before an oncoming car.
de_no_response: fail: rss.proper-response rss.longitudinal
    The car ahead slows to 36 km/h; the ego goes on for six seconds and brakes only then.
de_bend_too_fast: fail: comfort.lateral comfort.nuplan
    The ego takes a bend of 100 m radius at 86 km/h.
de_noise: notfail: comfort.accel-iso15622 comfort.lateral comfort.jerk-iso15622 comfort.nuplan crit.thw crit.mttc de.rg3
    The ego follows calmly at two seconds; the log trembles by 5 cm.
gb_tailgates_60: fail: hc.r126.thinking-gap hc.r126.stopping-gap crit.thw
    The ego follows at 58 mph eight metres behind a car.
gb_queue_rolls: notfail: hc.r126.thinking-gap crit.thw crit.ttc crit.ttb hc.r143.direction
    The ego rolls in a queue at walking pace, three metres behind a van.
gb_tailgates_2hz: notpass: hc.r126.thinking-gap crit.thw
    The ego follows at 58 mph six metres behind a car; the log has two steps a second.
gb_noisy_queue: notfail: hc.no-collision hc.r143.direction hc.contact-signature hc.r145.off-road crit.ttc
    The ego stands in a queue; the log trembles by 5 cm.
gb_cut_in_never_dropped_back: fail: hc.r168.drop-back crit.thw
    A car cuts in twelve metres ahead at 67 mph and the ego stays twelve metres behind it.
gb_cut_in_dropped_back: pass: hc.r168.drop-back; notfail: hc.r126.thinking-gap crit.ttc
    A faster car moves in 22 m ahead and the ego lets off until it has more than two seconds.
gb_cut_in_then_vanishes: notpass: hc.r168.drop-back
    A car cuts in twelve metres ahead at 67 mph and the log loses it four seconds later.
gb_forty_in_thirty: fail: hc.r124.speed-limit
    The ego drives 40 mph in a street of 30.
gb_hundred_unknown_limit: notpass: hc.r124.speed-limit
    The ego drives 100 mph on a rural road whose map has no limit.
gb_caravan_right_lane: fail: hc.r265.right-lane-ban; notfail: hc.r124.speed-limit
    A car that tows a caravan drives 58 mph in the rightmost of three lanes.
gb_hard_shoulder: fail: hc.r269.hard-shoulder
    The ego drives along the hard shoulder past a queue.
gb_hard_shoulder_breakdown: notfail: hc.r269.hard-shoulder hc.r240.no-stopping hc.r116.hazards
    The ego breaks down, puts its hazard lights on and stands on the hard shoulder.
gb_motorway_stop: fail: hc.r240.no-stopping
    The ego stops in lane one of an empty motorway and stands for 15 s.
gb_hazards_in_town: fail: hc.r116.hazards
    The ego drives through town at 27 mph with its hazard lights on.
gb_night_lit: fail: hc.r115.dipped-headlights; notfail: hc.r113.headlights
    The ego drives through town at night without headlights.
gb_horn_standing: fail: hc.r112.horn
    The ego stands alone at the roadside and sounds its horn.
gb_zebra_not_given: fail: hc.r195.zebra-on
    The ego drives over a zebra before somebody who has stepped onto its half and shrinks back.
gb_zebra_given: pass: hc.r195.zebra-on; notfail: hc.r191.no-stopping hc.r192.keep-clear crit.pet
    The ego stops before a zebra, lets somebody cross, and drives on.
gb_zebra_overtaking: fail: hc.r191.crossing-overtake hc.r195.zebra-on
    The ego overtakes a car that has stopped at a zebra for somebody on foot.
gb_zebra_parked_on: fail: hc.r191.no-stopping
    The ego stops on a zebra for twelve seconds of its own accord.
gb_zebra_blocked_by_queue: fail: hc.r192.keep-clear; notfail: hc.r191.no-stopping
    The ego follows a queue onto a zebra and stands on it for ten seconds.
gb_light_red: fail: hc.r175.red hc.r196.pelican
    The ego drives over a crossing whose light has been red for five seconds.
gb_light_green_still_crossing: fail: hc.r198.still-crossing; pass: hc.r175.red
    The light has turned green; the ego drives before somebody slow who is still on its half.
gb_stop_sign_kept: pass: hc.r171.stop-sign
    The ego halts for two seconds half a metre before the line of a stop sign.
gb_stop_sign_second_in_queue: fail: hc.r171.stop-sign
    The ego halts behind the car that waits at a stop line, and then rolls over the line behind it.
gb_side_road_blocked: fail: hc.r151.side-roads-clear
    The ego stands in a junction without lights for ten seconds behind a queue.
gb_right_turn_before_oncoming: fail: hc.r180.right-turn-gap crit.pet; notfail: hc.no-collision
    The ego turns right and is out of the way of an oncoming car one second before it.
gb_right_turn_corner_cut: fail: hc.r180.corner-cut
    The ego turns right across the corner and enters the road on its wrong side.
gb_left_turn_across_cyclist: fail: hc.h3.no-cut-across hc.r182.no-pass-before-turn hc.r163.cyclist
    The ego overtakes a cyclist and turns left right in front of them.
gb_left_turn_before_walker: fail: hc.h2.turn-pedestrian; notfail: hc.no-collision
    The ego turns left a second before somebody who is crossing the road that it turns into.
gb_left_turn_wide: fail: hc.r183.keep-in
    The ego swings out to the middle of the road that it turns left into.
gb_overtake_oncoming_near: fail: hc.r162.safe-distance-ahead hc.overtake-zone hc.r126.ds-ov-out-of-av
    The ego overtakes a lorry and slips back just before a car that has to brake hard for it.
gb_overtake_clear: pass: hc.r162.safe-distance-ahead; notfail: hc.overtake-zone hc.r126.ds-disjoint hc.r143.direction
    The ego overtakes a lorry with 900 m of empty road ahead.
gb_overtake_double_white: fail: hc.r129.no-cross-solid
    The ego overtakes a car at 45 mph over double white lines.
gb_double_white_slow_cyclist: notfail: hc.r129.no-cross-solid; pass: hc.r163.cyclist
    The ego straddles double white lines to give a cyclist at 7 mph two metres of room.
gb_back_too_late: fail: hc.r128.back-before-solid
    The ego overtakes where it may, but is still out when the line becomes double white.
gb_no_overtaking_sign: fail: hc.r165.no-overtaking-sign
    The ego overtakes a car after a no-overtaking sign.
gb_pulls_out_before_overtaker: fail: hc.r162.not-being-overtaken
    The ego pulls out to overtake although a car behind is already passing, which brakes hard.
gb_speeds_up_when_overtaken: fail: hc.r168.when-overtaken
    The ego speeds up from 40 to 54 mph while another car overtakes it.
gb_horse_fast_and_close: fail: hc.r215.horse
    The ego passes a ridden horse at 27 mph with a metre to spare.
gb_parked_car_forces_oncoming: fail: hc.r163.obstruction-give-way
    The ego goes round a parked car and makes an oncoming car brake to a halt.
gb_astride: fail: hc.r131.keep-in-lane
    The ego drives 15 s astride the line between two motorway lanes.
gb_wrong_side: fail: hc.r143.direction
    The ego drives on the wrong side of an empty rural road for 25 s.
gb_along_the_footway: fail: hc.r145.off-road
    The ego drives along the footway past a queue at 20 mph.
gb_onto_a_drive: notfail: hc.r145.off-road hc.r143.direction hc.no-collision
    The ego crosses the footway at 4 mph to reach a house.
gb_rear_end: fail: hc.no-collision crit.ttc crit.drac
    The ego brakes too late and hits a standing car.
gb_bump_that_the_boxes_miss: fail: hc.contact-signature
    The boxes stay 20 cm apart, but the ego loses 4 m/s in a tenth of a second and the car ahead gains as much.
gb_under_a_bridge: notfail: hc.no-collision crit.pet hc.contact-signature
    A lorry on a bridge passes over the ego at the same moment.
gb_reverses_unrecorded: notpass: said.r202.checks-before-reversing; notfail: hc.r143.direction
    The ego reverses ten metres along a street; the log declares no look back.
gb_motorway_reverse_only: fail: hc.r263.no-reverse hc.r143.direction; notfail: comfort.lateral
    The ego stands on a motorway and then reverses for ten seconds; it never drives forwards.
gb_green_into_standing_queue: fail: hc.r176.green-exit-clear; pass: hc.r175.red
    On green the ego drives into the junction up to a queue that has long stood there, and stands in the middle.
gb_cyclist_drew_up: notfail: hc.r126.thinking-gap hc.no-collision crit.thw
    A cyclist draws up beside the ego that waits in a queue and starts before it.
gb_hard_shoulder_with_hazards: notfail: hc.r269.hard-shoulder hc.r240.no-stopping hc.r116.hazards
    The ego breaks down, puts its hazard lights on at once and rolls to the hard shoulder.
gb_reverses_to_park: notfail: hc.r143.direction comfort.lateral comfort.accel-iso15622 hc.r145.off-road
    The ego drives past a gap, stops and reverses gently into it at walking pace.
gb_exit_unsignalled: fail: hc.exit-sign-signal
    The ego moves to the exit lane and leaves the motorway without any signal.
gb_exit_unsignalled_early: fail: hc.exit-sign-signal
    The ego moves to the exit lane before the first exit sign and leaves the motorway without any signal.
gb_exit_signalled: pass: hc.exit-sign-signal; notfail: hc.signal-then-leaves
    The ego signals left before the exit signs and leaves the motorway.
gb_signals_exit_and_goes_on: fail: hc.signal-then-leaves
    The ego signals left all along the exit lane and then drives straight on.
gb_parked_against_the_flow: fail: hc.r239.parked-with-traffic
    The ego crosses to the other side of the street and stands there for 68 s facing its traffic.
"""


_LINES = _TOLD.strip().splitlines()
_BY_NAME = {
    head.partition(": ")[0]: (what.strip(), head.partition(": ")[2])
    for head, what in zip(_LINES[::2], _LINES[1::2], strict=True)
}


def scene(name: str) -> Scene:
    """Return a scene by its name."""
    what, verdicts = _BY_NAME[name]
    expect = {}
    for part in verdicts.split(";"):
        verdict, rules = part.split(":")
        for rule in rules.split():
            pack, _, rest = rule.partition(".")
            expect[f"{_PACKS[pack]}.{rest}"] = _VERDICTS[verdict.strip()]
    return Scene(name, what, expect)
