"""An S3 server on loopback (moto's), and a proxy before it that fails as object stores do: busy, slow, cut off, silent."""

from __future__ import annotations

import http.client
import random
import threading
import time
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

if TYPE_CHECKING:
    from collections.abc import Iterator

_HOP = frozenset({"transfer-encoding", "connection", "content-length"})


@contextmanager
def s3() -> Iterator[str]:
    """Run an S3 server with the empty bucket `fleet`; yield its URL."""
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    try:
        connection = http.client.HTTPConnection(host, port)
        connection.request("PUT", "/fleet")
        assert connection.getresponse().status == 200
        yield f"http://{host}:{port}"
    finally:
        server.stop()


@contextmanager
def faults(server: str, share: float, seed: int = 0) -> Iterator[tuple[str, dict[str, int]]]:
    """Run a proxy that fails a share of requests; yield its URL and how often it has failed in which way."""
    rng, lock = random.Random(seed), threading.Lock()  # noqa: S311 - not a secret
    counted = dict.fromkeys(("busy", "slow", "cut", "silent"), 0)
    where = urlsplit(server).netloc

    class Proxy(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def _answer(self) -> None:
            with lock:
                kind = rng.choice(tuple(counted)) if rng.random() < share else None
            body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
            if kind == "cut" and self.command != "GET":
                kind = "silent"
            if kind is not None:
                counted[kind] += 1
            if kind == "busy":
                self.send_response(503)
                self.send_header("Content-Length", "0")
                self.end_headers()
                return
            if kind == "slow":
                time.sleep(0.5)
            connection = http.client.HTTPConnection(where)
            connection.request(self.command, self.path, body=body, headers=dict(self.headers))
            answer = connection.getresponse()
            content = answer.read()
            if kind == "silent":  # done, but nobody hears of it
                self.close_connection = True
                return
            self.send_response(answer.status)
            for name, value in answer.getheaders():
                if name.lower() not in _HOP:
                    self.send_header(name, value)
            length = answer.getheader("Content-Length") if self.command == "HEAD" else str(len(content))
            self.send_header("Content-Length", length or "0")
            self.end_headers()
            if kind == "cut":
                self.wfile.write(content[: len(content) // 2])
                self.close_connection = True
                return
            self.wfile.write(content)

        do_GET = do_PUT = do_POST = do_DELETE = do_HEAD = _answer  # noqa: N815 - the library's names

        def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - the library's name
            pass

    proxy = ThreadingHTTPServer(("127.0.0.1", 0), Proxy)
    running = threading.Thread(target=proxy.serve_forever, daemon=True)
    running.start()
    try:
        yield f"http://127.0.0.1:{proxy.server_address[1]}", counted
    finally:
        proxy.shutdown()
        proxy.server_close()
