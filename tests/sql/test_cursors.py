"""Cursors: an interrupt of a connection reaches the cursors of its cursors, and one that is closed meanwhile is no error."""

from __future__ import annotations

import threading
import time

import duckdb
import pytest

from drivelint.sql import store

ENDLESS = "SELECT sum(hash(a.range, b.range) % 7) FROM range(1000000) a, range(1000000) b"


def test_an_interrupt_reaches_a_cursor_of_a_cursor() -> None:
    with store.connect(threads=1) as con, store.cursor(con) as outer, store.cursor(outer) as inner:
        over = threading.Event()

        def interrupt_until_over() -> None:
            while not over.wait(0.05):
                store.interrupt(con)

        thread = threading.Thread(target=interrupt_until_over)
        thread.start()
        begin = time.monotonic()
        try:
            with pytest.raises(duckdb.InterruptException):
                inner.execute(ENDLESS).fetchall()
        finally:
            over.set()
            thread.join()
        assert time.monotonic() - begin < 60


def test_a_cursor_that_is_closed_meanwhile_is_no_error() -> None:
    with store.connect(threads=1) as con, store.cursor(con) as other:
        other.close()
        store.interrupt(con)
        assert con.execute("SELECT 1").fetchall() == [(1,)]
