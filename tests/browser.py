"""A page in Chromium without a screen: what a script found in it, and what the browser complained of."""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import pytest

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome"))), None)
needs_browser = pytest.mark.skipif(BROWSER is None, reason="there is no Chromium here")

# Without a screen a browser draws no pictures of its own accord, so a clock stands in for them.
WATCH = """<script>
window.wrong = [];
window.onerror = (text) => { wrong.push(text); };
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);
</script>"""
ACT = """<script>
const told = {};
setTimeout(async () => {
  try { %s } catch (problem) { wrong.push(`${problem}`); }
  told.wrong = wrong;
  const text = Object.assign(document.createElement("pre"), { textContent: "told " + JSON.stringify(told) });
  document.body.replaceChildren(text);
}, 300);
</script></body>"""


def played(page: Path, script: str, width: int = 1400) -> dict[str, Any]:
    """What `script` put into `told` after the page had been opened; fails on errors of its scripts or messages of the console."""
    text = page.read_text(encoding="utf-8").replace("<head>", "<head>" + WATCH).replace("</body>", ACT % script)
    copy = page.with_name(f"{page.stem}_played.html")
    copy.write_text(text, encoding="utf-8")
    assert BROWSER
    options = [
        "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={page.parent / 'user'}", f"--window-size={width},1200",
        "--virtual-time-budget=6000", "--enable-logging=stderr", "--dump-dom",
    ]  # fmt: skip
    done = subprocess.run([BROWSER, *options, copy.as_uri()], capture_output=True, text=True, timeout=60, check=False)
    found = re.search(r"<pre>told (\{.*?\})</pre>", done.stdout, re.DOTALL)
    assert found, done.stdout[-500:] + done.stderr[-2000:]
    told = json.loads(unescape(found[1]))
    assert [line for line in done.stderr.splitlines() if "CONSOLE" in line] == [] and told["wrong"] == []
    return told
