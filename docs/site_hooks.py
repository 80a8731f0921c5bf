"""What the site adds to the pages in this folder: documents of the repository, the API, plots drawn when it is built.

The pages link to files of the repository, so that they can be read there, too. Those that are documents become pages
of the site; of a link to another file, only its text is left.
"""

from __future__ import annotations

import importlib
import io
import posixpath
import re
import runpy
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.structure.files import File, Files

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.pages import Page

HERE = Path(__file__).parent
ROOT = HERE.parent

EXAMPLES = sorted(ROOT.glob("examples/*/README.md"))

SCHEMAS = sorted(ROOT.glob("replicate/schemas/*.json"))

#: Documents outside this folder, by the page that they become.
DOCUMENTS = {
    "architecture.md": "ARCHITECTURE.md",
    "contributing.md": "CONTRIBUTING.md",
    "changes.md": "CHANGELOG.md",
} | {f"examples/{file.parent.name}.md": f"examples/{file.parent.name}/README.md" for file in EXAMPLES}

#: Modules whose public names the API lists, by page.
API = {
    "loops": "replicate.loops",
    "tune": "replicate.loops.tune",
    "inputs": "replicate.loops.inputs",
    "plots": "replicate.loops.plots",
    "exhibits": "replicate.exhibits",
    "figures": "replicate.figures",
}

_LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(#[^)\s]*)?\)")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are made."""
    for page, document in DOCUMENTS.items():
        files.append(File.generated(config, page, content=(ROOT / document).read_text(encoding="utf-8")))
    for page, module in API.items():
        files.append(File.generated(config, f"api/{page}.md", content=_api(module)))
    for schema in SCHEMAS:
        files.append(File.generated(config, f"schemas/{schema.name}", content=schema.read_text(encoding="utf-8")))
    for script in sorted((HERE / "plots").glob("*.py")):
        files.append(File.generated(config, f"plots/{script.stem}.svg", content=_drawn(script)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001  -- mkdocs names them
    """Turn links to files of the repository into links to pages, or into their text."""
    here = page.file.src_uri
    source = posixpath.dirname(DOCUMENTS.get(here, f"docs/{here}"))
    return _LINK.sub(lambda link: _relinked(link, source, posixpath.dirname(here)), markdown)


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:  # noqa: ARG001  -- mkdocs names them
    """Leave the formulas of docstrings as they are typed: what typesets them would have to be fetched."""
    return html.replace(":math:<code>", "<code>")


def _relinked(link: re.Match[str], source: str, here: str) -> str:
    image, text, target, anchor = link.groups()
    if "://" in target or target.startswith("mailto:"):
        return link[0]
    place = posixpath.normpath(posixpath.join(source, target))
    pages = {document: page for page, document in DOCUMENTS.items()}
    pages |= {f"replicate/schemas/{schema.name}": f"schemas/{schema.name}" for schema in SCHEMAS}
    page = pages.get(place) or (place.removeprefix("docs/") if place.startswith("docs/") else None)
    if page is None:
        return text
    return f"{image}[{text}]({posixpath.relpath(page, here or '.')}{anchor or ''})"


def _api(module: str) -> str:
    """Return a page with a place for the documentation of each public name."""
    imported = importlib.import_module(module)
    words = (imported.__doc__ or "").strip()
    places = "\n\n".join(f"::: {module}.{name}" for name in imported.__all__)
    return f"# {module}\n\n{words}\n\n{places}\n"


def _drawn(script: Path) -> str:
    """Return the SVG of the figure that a script's function ``draw`` returns."""
    import matplotlib as mpl

    content = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": script.stem, "svg.fonttype": "none"}):
        runpy.run_path(str(script))["draw"]().savefig(content, format="svg", metadata={"Date": None})
    return content.getvalue()
