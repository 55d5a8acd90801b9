"""An ego that vanishes while its log goes on is missed, in every format: no exit code 0 or 1, and the reason is said."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from drivelint import cli
from tests.absence import drives
from tests.absence.drives import EGO, FORMATS, N, without
from tests.formats.osi import osi_log
from tests.formats.ros2 import ros_log
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.faults.drives import Frame

RULE = "ukhc.no-collision"
WITH_OWN_EGO = [name for name, each in FORMATS.items() if each.is_own]
PICKED = [name for name, each in FORMATS.items() if not each.is_own]
EMPTY = [name for name, each in FORMATS.items() if each.has_empty_frames]
FROM, UNTIL, BETWEEN = range(20, N), range(54), range(20, 56)
OSI = {"osi-mcap": drives.osi_mcap_with_host, "osi-file": drives.osi_file_with_host}
Outcome = tuple[int, dict[str, Any], list[dict[str, Any]]]


def check_outcome(path: Path, **options: Any) -> Outcome:
    """Return the exit code, the drive and the verdicts of a check."""
    result = drivelint.check([path], rules=RULE, annotate=False, robustness=False, **options)
    (drive,) = result.drives.arrow().to_pylist()
    return result.exit_code, drive, result.verdicts.arrow().to_pylist()


def of(name: str, folder: Path, frames: list[Frame], **options: Any) -> Outcome:
    """Return the check of a drive in a format."""
    path = FORMATS[name].write(folder / "log", frames)
    return check_outcome(path, **{**FORMATS[name].options(path), **options})


def absence(drive: dict[str, Any]) -> list[str]:
    """Return what is said of an ego that is absent."""
    return [found["message"] for found in drive["quality"] if found["check_id"] == "ego_absent"]


def require_missed(outcome: Outcome, share: str, gap: range, ego: str = EGO) -> None:
    """Require that the loss is said with its share, and that no verdict passes over a frame without the ego."""
    code, drive, rows = outcome
    decided = any(row["verdict"] in {"pass", "fail"} for row in rows)
    assert (code, drive["lossy"]) == (3 if decided else 4, True)
    (message,) = absence(drive)
    named = "the ego" if ego == "ego" else f"the ego {ego}"
    assert message.startswith(f"{named} is absent for {share}, from "), message
    start, begin, end = drive["t_start_ns"], gap.start * 10**8, gap[-1] * 10**8
    for row in rows:
        within = row["t_start_ns"] - start <= end and row["t_end_ns"] - start >= begin
        assert not (within and row["verdict"] in {"pass", "not_applicable"}), row
    assert "unknown" in {row["verdict"] for row in rows}


@pytest.mark.parametrize("name", FORMATS)
def test_the_whole_drive_is_a_collision(name: str, tmp_path: Path) -> None:
    """Or else the tests below would hold for a checker that sees nothing."""
    code, drive, rows = of(name, tmp_path, drives.drive())
    assert (code, drive["lossy"], absence(drive)) == (1, False, [])
    assert "fail" in {row["verdict"] for row in rows}
    assert drive["duration_s"] == pytest.approx(5.9)


@pytest.mark.parametrize("name", WITH_OWN_EGO)
@pytest.mark.parametrize(
    ("gap", "share"),
    [(FROM, "4.0 of 5.9 s (68 %)"), (UNTIL, "5.4 of 5.9 s (92 %)"), (BETWEEN, "3.7 of 5.9 s (63 %)")],
    ids=["from a frame on", "until a frame", "between two frames"],
)
def test_the_ego_is_gone(name: str, tmp_path: Path, gap: range, share: str) -> None:
    require_missed(of(name, tmp_path, without(drives.drive(), gap, EGO)), share, gap, FORMATS[name].ego)


@pytest.mark.parametrize("name", WITH_OWN_EGO)
def test_everybody_is_gone_between_two_frames(name: str, tmp_path: Path) -> None:
    outcome = of(name, tmp_path, without(drives.drive(), BETWEEN))
    require_missed(outcome, "3.7 of 5.9 s (63 %)", BETWEEN, FORMATS[name].ego)


@pytest.mark.parametrize("name", EMPTY)
def test_everybody_is_gone_from_a_frame_on(name: str, tmp_path: Path) -> None:
    """What has no trace of a frame in which nobody is, a log of rows, just ends there."""
    outcome = of(name, tmp_path, without(drives.drive(), FROM))
    require_missed(outcome, "4.0 of 5.9 s (68 %)", FROM, FORMATS[name].ego)
    assert outcome[1]["duration_s"] == pytest.approx(5.9)


@pytest.mark.parametrize("host", drives.HOSTS)
@pytest.mark.parametrize("gap", [FROM, BETWEEN], ids=["from a frame on", "between two frames"])
@pytest.mark.parametrize("name", OSI)
def test_everybody_is_gone_and_the_host_is_another(name: str, gap: range, host: str, tmp_path: Path) -> None:
    path = OSI[name](tmp_path / "log", without(drives.drive(), gap), gap, drives.HOSTS[host])
    if drives.HOSTS[host] == 99:  # the host of most frames
        with pytest.raises(drivelint.DriveLintError, match="the log's ego '99' has no states") as error:
            check_outcome(path)
        assert error.value.exit_code == 4
        return
    require_missed(check_outcome(path), "4.0 of 5.9 s (68 %)" if gap == FROM else "3.7 of 5.9 s (63 %)", gap)


@pytest.mark.parametrize("name", WITH_OWN_EGO)
def test_single_frames_that_lack_are_no_loss(name: str, tmp_path: Path) -> None:
    frames = without(without(drives.drive(), range(10, 11), EGO), range(30, 31), EGO)
    code, drive, _ = of(name, tmp_path, frames)
    assert (code, drive["lossy"], absence(drive)) == (1, False, [])


@pytest.mark.parametrize("name", WITH_OWN_EGO)
def test_who_names_the_logs_own_ego_misses_it_too(name: str, tmp_path: Path) -> None:
    frames, ego = without(drives.drive(), FROM, EGO), FORMATS[name].ego
    require_missed(of(name, tmp_path, frames, ego=ego), "4.0 of 5.9 s (68 %)", FROM, ego)


@pytest.mark.parametrize("name", PICKED)
@pytest.mark.parametrize("gap", [FROM, UNTIL], ids=["from a frame on", "until a frame"])
def test_one_of_many_that_drives_away_is_no_loss(name: str, gap: range, tmp_path: Path) -> None:
    """A vehicle arrives, or leaves the recorded area: the user picked it, and it is judged while it is there."""
    code, drive, rows = of(name, tmp_path, without(drives.drive(), gap, EGO))
    assert (code, drive["lossy"], absence(drive)) == (0, False, [])
    (message,) = (found["message"] for found in drive["quality"] if found["check_id"] == "ego_chosen")
    assert message.endswith(f"of its track, {'1.9' if gap == FROM else '0.5'} of 5.9 s of the log")
    assert {row["verdict"] for row in rows} <= {"pass", "unknown", "not_applicable"}


@pytest.mark.parametrize("name", PICKED)
def test_one_of_many_that_is_gone_between_two_frames_is_missed(name: str, tmp_path: Path) -> None:
    """Nobody leaves the world and comes back to it."""
    outcome = of(name, tmp_path, without(drives.drive(), BETWEEN, EGO))
    require_missed(outcome, "3.7 of 5.9 s of its track (63 %)", BETWEEN)


@pytest.mark.parametrize("name", ["osi-mcap", "bare parquet", "sumo", "commonroad"])
@pytest.mark.parametrize("gap", [FROM, BETWEEN], ids=["from a frame on", "between two frames"])
def test_every_vehicle_in_turn_has_the_time_of_its_track(name: str, gap: range, tmp_path: Path) -> None:
    code, drive, _ = of(name, tmp_path, without(drives.drive(), gap, "2"), ego="all")
    assert (code, drive["lossy"], absence(drive)) == (1, False, [])
    assert [found["actor_id"] for found in drive["quality"] if found["check_id"] == "egos_chosen"] == [
        EGO if name == "osi-mcap" else None
    ]


def test_the_recorders_own_ego_is_missed_among_all(tmp_path: Path) -> None:
    code, drive, _ = of("osi-mcap", tmp_path, without(drives.drive(), FROM, EGO), ego="all")
    assert (code, drive["lossy"]) == (3, True)  # the other two meet nobody
    assert absence(drive)


@pytest.mark.ci
def test_a_place_that_is_not_recorded_is_none(tmp_path: Path) -> None:
    """The ego is named in every frame, and without a position in most of them."""
    truths = drives.osi_with_host(drives.drive(), range(0), None)
    for i in FROM:
        truths[i].moving_object[0].base.ClearField("position")
    path = osi_log.write(tmp_path / "log.mcap", osi_log.truths(truths))
    require_missed(check_outcome(path), "4.0 of 5.9 s (68 %)", FROM)


@pytest.mark.slow
def test_topics_begin_and_end_beside_each_other(tmp_path: Path) -> None:
    """A recorder of ROS finds the odometry up to a second after the objects."""
    missing = [*range(8), *range(N - 8, N)]
    frames = [
        frame._replace(cars=[car for car in frame.cars if car.name != EGO or i not in missing])
        for i, frame in enumerate(drives.drive())
    ]
    code, drive, _ = of("ros odometry", tmp_path, frames)
    assert (code, drive["lossy"]) == (1, False)
    code, drive, _ = of("osi-mcap", tmp_path, frames)
    assert (code, drive["lossy"]) == (1, True)


Screen = Callable[..., tuple[int, str]]


@pytest.fixture
def screen(capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Screen:
    """Return a function that runs a command and returns its exit code and what it prints, as one line."""

    def run(*arguments: str) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", ["drivelint", *arguments])
        monkeypatch.setenv("COLUMNS", "120")
        with pytest.raises(SystemExit) as ended:
            cli.main()
        return int(ended.value.code or 0), " ".join(capfd.readouterr().out.split())

    return run


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--strict",)])
def test_the_first_screen_says_it(tmp_path: Path, screen: Screen, more: tuple[str, ...]) -> None:
    """The near miss of the fixtures without its ego from frame 60 of 181 on."""
    path = near_miss(tmp_path, lambda i: i >= 60)
    road = str(ROOT / "fixtures" / "scenes" / "overtake-road.xodr")
    code, out = screen("check", str(path), "--map", road, "--out", str(tmp_path / "out"), "--no-annotate", *more)
    said = "the ego 1 is absent for 12.1 of 18.0 s (67 %)"
    assert said in out.partition("not judged:")[0]
    assert code == (4 if more else 3)
    for name in ("report.html", "summary.json"):
        assert said in (tmp_path / "out" / name).read_text(encoding="utf-8"), name
    _, out = screen("inspect", str(path))
    assert said in out


def near_miss(folder: Path, is_gone: Callable[[int], bool]) -> Path:
    """Return the near miss of the fixtures without its ego in some frames."""
    from mcap.reader import make_reader

    truths: list[Any] = []
    with (ROOT / "fixtures" / "scenes" / "near-miss.mcap").open("rb") as file:
        for schema, _, message in make_reader(file).iter_messages(log_time_order=False):
            assert schema is not None
            if schema.name == "osi3.GroundTruth":
                truth = osi_log.message("GroundTruth")
                truth.ParseFromString(message.data)
                if is_gone(len(truths)):
                    others = [each.SerializeToString() for each in truth.moving_object if each.id.value != 1]
                    del truth.moving_object[:]
                    for data in others:
                        truth.moving_object.add().ParseFromString(data)
                truths.append(truth)
    assert len(truths) == 181
    return osi_log.write(folder / "near-miss.mcap", osi_log.truths(truths))


@pytest.mark.ci
def test_a_frame_far_from_all_others_is_no_part_of_the_drive(tmp_path: Path) -> None:
    """The first message may hold the road alone, with a time of zero, where the others count from 1970."""
    truths = drives.osi_with_host(drives.drive(), range(0), None)
    for truth in truths:
        truth.timestamp.seconds += 1_700_000_000
    path = osi_log.write(tmp_path / "log.mcap", osi_log.truths([osi_log.frame(0), *truths]))
    code, drive, _ = check_outcome(path)
    assert (code, drive["lossy"], drive["duration_s"]) == (1, False, pytest.approx(5.9))


@pytest.mark.slow
def test_a_fast_odometry_among_slow_objects(tmp_path: Path) -> None:
    """At 100 Hz, and gone for three seconds in which objects come at 10 Hz: one stretch is unknown, not thirty."""
    messages = [ros_log.things(k / 10, ros_log.thing(1, 300.0, 4.0), topic="/objects") for k in range(60)]
    messages += [ros_log.odometry(k / 100, k / 10, 0.0, 0.0, 10.0) for k in range(600) if k < 200 or k >= 500]
    path = ros_log.write(tmp_path / "log.mcap", sorted(messages, key=lambda message: message[2]))
    code, drive, rows = check_outcome(path, ego_size="4.5,1.8")
    assert (code, drive["lossy"]) == (3, True)
    assert absence(drive) == [
        "the ego is absent for 3.0 of 6.0 s (50 %), from 1.990 s to 5.000 s: what it did in that time is unknown"
    ]
    assert len([row for row in rows if row["verdict"] == "unknown"]) <= 6
    trembling = [message for k, message in enumerate(messages) if k % 40]  # single samples lack
    code, drive, _ = check_outcome(
        ros_log.write(tmp_path / "b.mcap", sorted(trembling, key=lambda m: m[2])), ego_size="4.5,1.8"
    )
    assert absence(drive) == absence(check_outcome(path, ego_size="4.5,1.8")[1])


@pytest.mark.parametrize("gap", [FROM, UNTIL, BETWEEN], ids=["from a frame on", "until a frame", "between two frames"])
def test_a_topic_of_road_users_falls_silent(tmp_path: Path, gap: range) -> None:
    """Nobody there is a message without objects; without a message nobody knows."""
    frames = drives.drive()
    messages = [ros_log.odometry(t_s, cars[0].x, 0.0, 0.0, cars[0].vx) for t_s, cars in frames]
    others = [ros_log.things(t_s, ros_log.thing(1, cars[1].x, 0.0, 0.0, 6.0), topic="/objects") for t_s, cars in frames]
    empty = [ros_log.things(t_s, topic="/objects") for t_s, _ in frames]
    heard = [each for k, each in enumerate(others) if k not in gap]
    for beside, code in ((others, 1), (heard, 3), ([empty[k] if k in gap else others[k] for k in range(N)], 0)):
        path = ros_log.write(tmp_path / "log.mcap", sorted([*messages, *beside], key=lambda message: message[2]))
        found, drive, rows = check_outcome(path, ego_size="4.5,1.8")
        lost = [each["message"] for each in drive["quality"] if each["check_id"] == "lost_time"]
        decided = any(row["verdict"] in {"pass", "fail"} for row in rows)
        assert (found, bool(lost)) == (code if decided else 4, code == 3)
        assert not lost or "/objects has no messages while the odometry continues" in lost[0]
        assert code != 3 or not any(row["verdict"] == "pass" and row["object_id"] is None for row in rows)
