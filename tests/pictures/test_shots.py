"""Which pictures are taken: bounded, the worst first, and the same whether logs are judged together or in parts."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from drivelint.pictures.shots import MOST_CAMERAS, MOST_MOMENTS, MOST_SHOTS, shots_of_moments

CAMERAS = {f"drive{n}": tuple(f"/camera{k}" for k in range(1 + n % 5)) for n in range(8)}
MOMENTS = st.lists(st.tuples(st.sampled_from(sorted(CAMERAS)), st.integers(0, 200)), unique=True, max_size=120)


@given(MOMENTS, st.sets(st.sampled_from(sorted(CAMERAS))))
def test_what_all_drives_show_their_parts_have_taken(moments: list[tuple[str, int]], part: set[str]) -> None:
    planned = shots_of_moments(moments, CAMERAS)
    assert len(planned) == len(set(planned)) <= MOST_SHOTS
    assert len({(shot.drive_id, shot.t_ns) for shot in planned}) <= MOST_MOMENTS
    assert all(shot.camera_no < min(len(CAMERAS[shot.drive_id]), MOST_CAMERAS) for shot in planned)
    for drives in (part, CAMERAS.keys() - part):
        mine = [moment for moment in moments if moment[0] in drives]
        assert {shot for shot in planned if shot.drive_id in drives} <= set(shots_of_moments(mine, CAMERAS))


def test_every_moment_has_a_picture_before_any_has_one_of_another_camera() -> None:
    moments = [("drive4", t) for t in range(30)]
    planned = shots_of_moments(moments, CAMERAS)
    assert [shot.t_ns for shot in planned if (shot.camera_no, shot.shot) == (0, "at")] == list(range(30))
    assert {shot.t_ns for shot in planned if shot.camera_no > 0} == set(range(5))
