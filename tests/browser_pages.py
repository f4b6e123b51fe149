"""Pages in the Chromium of this system, driven by playwright: what a person sees, and nothing that goes wrong unseen."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Page, sync_playwright

from .browser import BROWSER

HERE = ("127.0.0.1", "localhost", "")

# In CI a missing browser is a failure, elsewhere these tests are skipped.
needs_chromium = pytest.mark.skipif(BROWSER is None and not os.environ.get("CI"), reason="there is no Chromium here")


@contextmanager
def opened(address: str, width: int = 1400, refusals: int = 0, **options: Any) -> Iterator[Page]:
    """A page; when it is left, it must have written nothing to the console, raised nothing, and asked no other machine.

    `refusals` is the number of requests that its server must have refused, of which browsers write a line each.
    """
    wrong: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        try:
            page = browser.new_page(viewport={"width": width, "height": 1000}, **options)
            page.set_default_timeout(30_000)
            page.on("console", lambda message: wrong.append(f"console: {message.text}"))
            page.on("pageerror", lambda error: wrong.append(f"error: {error}"))
            page.on("request", lambda request: wrong.extend(_elsewhere(request.url)))
            page.goto(address)
            yield page
        finally:
            browser.close()
    refused = [one for one in wrong if "status of 422" in one]
    assert len(refused) == refusals and wrong == refused


def _elsewhere(address: str) -> list[str]:
    """A request that leaves the machine."""
    parts = urlsplit(address)
    return [] if parts.scheme in ("data", "blob") or (parts.hostname or "") in HERE else [f"request: {address}"]
