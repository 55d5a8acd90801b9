"""The scenes of a few modules are derived together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests import together

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module", autouse=True)
def _answered_together(request: pytest.FixtureRequest) -> None:
    mine = together.chunk(request.path)
    together.answer_together(
        [
            item
            for item in request.session.items
            if item.path.parent == request.path.parent and together.chunk(item.path) == mine
        ]
    )


@pytest.fixture(autouse=True)
def _answered(request: pytest.FixtureRequest, _answered_together: None) -> Iterator[None]:
    with together.answers.running(request.node.nodeid):
        yield


def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """Close the databases of the answers after the last test that may ask for one: they take a gigabyte."""
    if nextitem is None or together.chunk(nextitem.path) != together.chunk(item.path):
        together.answers.forget()
