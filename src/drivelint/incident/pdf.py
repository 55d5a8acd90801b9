"""Prints a page to PDF with an installed Chromium. No library on PyPI can draw this page without system libraries."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from drivelint.errors import DriveLintError, ExitCode, UsageError

_BROWSER_COMMANDS: Final = (
    "chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge", "msedge",
)  # fmt: skip
_PRINT_TIMEOUT_S: Final = 120
_DATE_PATTERN: Final = re.compile(rb"(/(?:CreationDate|ModDate) \(D:)\d{14}")


class PdfError(DriveLintError):
    """Error: the browser did not print the page."""

    exit_code = ExitCode.TEMPFAIL


def find_browser() -> str:
    """Return the path of an installed browser that can print a PDF. Errors: `UsageError` if there is none."""
    browser = next((path for name in _BROWSER_COMMANDS if (path := shutil.which(name))), None)
    if browser is None:
        raise UsageError(
            "--pdf needs Chromium to print the PDF, and none is installed: install chromium (or Google Chrome), or print the HTML page "
            "from any browser on A4"
        )
    return browser


def pdf_of_page(html: bytes, browser: str) -> bytes:
    """Return a page as PDF; the same page and browser give the same bytes. Errors: `PdfError`."""
    with TemporaryDirectory(prefix="drivelint-") as folder:
        page, out = Path(folder, "page.html"), Path(folder, "page.pdf")
        page.write_bytes(html)
        flags = ["--headless=new", "--disable-gpu", "--no-first-run", f"--user-data-dir={folder}/profile"]
        # Chromium's sandbox refuses to run as root, as in containers; our page loads nothing
        flags += ["--no-sandbox"] if getattr(os, "geteuid", lambda: 1)() == 0 else []
        command = [browser, *flags, "--no-pdf-header-footer", f"--print-to-pdf={out}", page.as_uri()]
        try:
            subprocess.run(command, check=True, capture_output=True, timeout=_PRINT_TIMEOUT_S)  # noqa: S603 - no shell, our words
            content = out.read_bytes()
        except (OSError, subprocess.SubprocessError) as error:
            raise PdfError(
                f"{browser} did not print the page: {str(error).splitlines()[0]}: print the HTML page from another browser"
            ) from error
    return _DATE_PATTERN.sub(rb"\g<1>19700101000000", content)
