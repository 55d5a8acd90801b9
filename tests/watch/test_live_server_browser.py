"""In a browser: only a page whose origin is allowed can watch."""

from __future__ import annotations

from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from threading import Thread
from typing import TYPE_CHECKING

import pytest

from tests.report.browser import CHROMIUM, Page

pytest.importorskip("websockets")

from drivelint.watch.server import LiveServer

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed here")]

TRIED = """new Promise(done => {{
  const ws = new WebSocket("ws://127.0.0.1:{port}", ["foxglove.sdk.v1"]);
  ws.onmessage = () => done("watches");
  ws.onerror = () => done("refused");
}})"""


@pytest.mark.parametrize(("is_allowed", "answer"), [(False, "refused"), (True, "watches")])
def test_a_page_watches_only_where_its_origin_is_allowed(tmp_path: Path, is_allowed: bool, answer: str) -> None:
    (tmp_path / "www").mkdir()
    (tmp_path / "www" / "index.html").write_text("<p>a page", encoding="utf-8")
    site = ThreadingHTTPServer(("127.0.0.1", 0), partial(SimpleHTTPRequestHandler, directory=str(tmp_path / "www")))
    Thread(target=site.serve_forever, daemon=True).start()
    origin = f"http://127.0.0.1:{site.server_port}"
    server = LiveServer("127.0.0.1", 0, origins=[origin] if is_allowed else [])
    try:
        with Page(tmp_path / "profile", origin) as page:
            assert page.value(TRIED.format(port=server.port)) == answer
    finally:
        server.close()
        site.shutdown()
    assert any(origin in note for note in server.notes()) is not is_allowed
