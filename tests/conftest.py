"""A browser for the tests that look at pages, and the studio for those that use it."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")

SOFTWARE = (
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--use-gl=angle",
    "--use-angle=swiftshader",
)
"""WebGL without a graphics card."""


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """The system's Chromium, headless; tests that need one are skipped where there is none.

    Its driver keeps an event loop running, which tests of other modules must not meet.
    """
    if CHROMIUM is None:
        pytest.skip("no Chromium is installed")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=list(SOFTWARE))
        yield browser
        browser.close()


class Studio:
    """A running ``gridshell view`` and its address."""

    def __init__(self, path: Path, *more: str) -> None:
        main = "from fabrication.cli import main; main()"
        self.process = subprocess.Popen(
            [sys.executable, "-c", main, "view", str(path), "--no-browser", *more],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={key: value for key, value in os.environ.items() if not key.startswith("PYTEST")},
        )
        assert self.process.stdout is not None
        self.said = self.process.stdout.readline()
        found = re.search(r"http://\S+", self.said)
        self.address = found[0] if found else None

    def visit(self, page: Any, address: str | None = None) -> Any:
        """Go to *address*, or the studio's own, as soon as somebody listens there."""
        for _ in range(60):
            try:
                return page.goto(address or self.address)
            except Exception:  # noqa: BLE001 - the server is about to listen
                time.sleep(0.25)
        raise TimeoutError(address or self.address)

    def end(self) -> tuple[int, str]:
        """Ctrl-C; the exit code and what it says."""
        self.process.send_signal(signal.SIGINT)
        more, _ = self.process.communicate(timeout=20)
        return self.process.returncode, more


@pytest.fixture
def start_studio() -> Iterator[Callable[..., Studio]]:
    """Starts studios, and ends those that a test leaves running."""
    started: list[Studio] = []

    def start(path: Path, *more: str) -> Studio:
        started.append(Studio(path, *more))
        return started[-1]

    yield start
    for studio in started:
        if studio.process.poll() is None:
            studio.end()
