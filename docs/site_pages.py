"""Pages of the site that lie outside docs/, and links of pages to files outside docs/: a hook of mkdocs."""

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

PAGES = ("benchmarks/RESULTS.md", "CHANGELOG.md", "CONTRIBUTING.md")
_LINK = re.compile(r"(?<!!)\[([^\]\n]+)\]\((?![a-z]+:)([^)\s#]+)(#[^)\s]*)?\)|(!\[[^\]\n]*\])\((?![a-z]+:)([^)\s]+)\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages, under their paths in the repository."""
    for page in PAGES:
        files.append(File.generated(config, page, content=(_root(config) / page).read_text("utf-8")))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Turn links between paths of the repository into links between pages; files that the site does not have are only named.

    A link to a file that the repository does not have either stays as it is, and mkdocs reports it.
    """
    source = page.file.src_uri
    folder = posixpath.dirname(source if source in PAGES else f"docs/{source}")

    def replaced(link: re.Match[str]) -> str:
        label, path = (link[4], link[5]) if link[4] else (f"[{link[1]}]", link[2])
        target = posixpath.normpath(posixpath.join(folder, path))
        uri = target.removeprefix("docs/")
        if files.get_file_from_path(uri):
            return f"{label}({posixpath.relpath(uri, posixpath.dirname(source) or '.')}{link[3] or ''})"
        if not (_root(config) / target).exists():
            return link[0]
        name = label[1:-1]
        return name if re.search("[ `]", name) else f"`{name}`"

    return _LINK.sub(replaced, markdown)


def _root(config: MkDocsConfig) -> Path:
    return Path(config.config_file_path).parent
