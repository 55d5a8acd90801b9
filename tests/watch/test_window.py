"""The frames of the last seconds of a log: none is lost, none comes twice, and every one has its past before it."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from drivelint.watch.source import Frame
from drivelint.watch.window import Window

times = st.lists(st.integers(0, 500), min_size=1, max_size=60).map(sorted)


@given(times, st.integers(1, 60), st.integers(1, 40), st.lists(st.integers(1, 7), min_size=1, max_size=60))
def test_every_frame_is_in_a_window_once_it_is_new_with_all_that_is_less_than_the_window_older(
    stamps: list[int], length: int, step_ns: int, portions: list[int]
) -> None:
    window, step_ns = Window(length), min(step_ns, length)  # a step must not leave the window before it was seen in one
    new: list[int] = []
    todo, at = list(enumerate(stamps)), 0
    for portion in [*portions, *[1] * len(todo)]:
        window.add(Frame(t_ns, no, 1) for no, t_ns in todo[at : at + portion])
        at += portion
        while window.advance(step_ns):
            held = window.frames
            newest = held[-1].t_ns
            assert [f.data for f in held] == [no for no, t in todo if newest - length <= t and no <= held[-1].data]  # type: ignore[operator]
            assert window.is_whole is (held[0].data == 0)
            new += [f.data for f in held if f.data not in new]  # type: ignore[misc]
    assert new == [no for no, _ in todo]


def test_the_window_moves_by_no_more_than_is_asked_for_but_over_a_hole() -> None:
    window = Window(30)
    window.add(Frame(t, t, 1) for t in (0, 5, 10, 100, 104))
    ends = []
    while window.advance(5):
        ends.append(window.frames[-1].t_ns)
    assert ends == [5, 10, 104]


def test_where_the_clock_jumps_the_window_begins_anew_and_every_frame_is_judged() -> None:
    """A single frame of the next day, then a clock that starts again."""
    window = Window(30)
    stamps = [*range(0, 50, 5), 86400, *range(50, 100, 5), *range(0, 50, 5)]
    window.add(Frame(t, no, 1) for no, t in enumerate(stamps))
    seen: list[int] = []
    while window.advance(5):
        held = [frame.t_ns for frame in window.frames]
        assert max(held) - min(held) <= 30
        seen += [f.data for f in window.frames if f.data not in seen]  # type: ignore[misc]
    assert seen == list(range(len(stamps)))
    assert window.jumps == [(45, 86400), (86400, 50), (95, 0)]
    assert not window.is_whole


def test_how_far_it_is_behind() -> None:
    window = Window(10)
    assert window.unjudged_ns == 0
    window.add(Frame(t, t, 1) for t in (3, 9))
    assert window.unjudged_ns == 6
    window.advance(100)
    assert window.unjudged_ns == 0
    window.add([Frame(19, 19, 1)])
    assert window.unjudged_ns == 10
