"""The page of the app, and the styles and scripts that it loads."""

from pathlib import Path

from starlette.responses import Response

from ..report import page as report_page

HERE, REPORT = Path(__file__).parent, Path(report_page.__file__).parent
FILES = {
    "style.css": REPORT, "app.css": HERE, "app.js": HERE, "elements.js": HERE, "data_step.js": HERE, "model_steps.js": HERE,
}  # fmt: skip
KINDS = {".css": "text/css", ".js": "text/javascript"}
# Reports carry their styles and scripts within themselves; they may ask nothing of anybody.
REPORT_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; frame-ancestors 'self'"


def page() -> Response:
    """The page."""
    return Response((HERE / "app.html").read_bytes(), media_type="text/html")


def static(name: str) -> Response:
    """A style or script; 404 for any other name."""
    if name not in FILES:
        return Response("not found", 404)
    return Response((FILES[name] / name).read_bytes(), media_type=KINDS[Path(name).suffix])


def report(path: Path | None) -> Response:
    """A report as a command would have written it; 404 if there is none."""
    if path is None or not path.is_file():
        return Response("there is no such page (yet)", 404)
    return Response(path.read_bytes(), media_type="text/html", headers={"content-security-policy": REPORT_POLICY})
