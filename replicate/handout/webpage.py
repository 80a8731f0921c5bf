"""A handout as one web page: formulas as MathML, figures as inline SVG, nothing fetched, no script."""

from __future__ import annotations

import html
import json

import pypandoc
from markupsafe import Markup

import replicate
from replicate.display.inline_svg import inline_svg
from replicate.display.rendering import html_environment
from replicate.display.source_code import highlight
from replicate.exhibits.plain_text import visible
from replicate.handout.edition import Document
from replicate.handout.tree import Element, attribute, classes, plain, raw_block, raw_inline, transform

TEMPLATE = "handout.html"


def webpage(document: Document) -> str:
    """Return the page as HTML."""
    blocks = transform(document.blocks, lambda element: _for_html(element, document))
    empty = json.loads(pypandoc.convert_text("", "json", format="markdown"))
    body = str(
        pypandoc.convert_text(
            json.dumps(empty | {"blocks": blocks}),
            "html",
            format="json",
            extra_args=["--sandbox", "--wrap=none", "--fail-if-warnings", "--shift-heading-level-by=1"],
        )
    )
    return visible(
        html_environment()
        .get_template(TEMPLATE)
        .render(
            title=document.title,
            paper=document.paper,
            solutions=document.solutions,
            body=Markup(body.replace("\r\n", "\n")),  # noqa: S704  -- the project's own text
            software=f"replicate {replicate.__version__}",
        )
    )


def _for_html(element: Element, document: Document) -> list[Element] | None:
    """Replace formulas, programs and drawings by HTML; classes of everything else reach the style sheet."""
    match element["t"]:
        case "Math":
            kind, tex = element["c"]
            return [raw_inline("html", document.formulas[kind["t"] == "DisplayMath", tex].mathml)]
        case "CodeBlock":
            code, names = element["c"][1], classes(element)
            text = highlight(code) if "python" in names else html.escape(code, quote=False)
            return [raw_block("html", f'<pre class="{" ".join(names)}"><code>{text}</code></pre>')]
        case "Div" if "drawing" in classes(element):
            drawing = document.drawings[attribute(element, "name")]
            svg = inline_svg(drawing.svg, f"svg-{drawing.name}", drawing.name, drawing.alt)
            head = raw_block("html", f'<figure class="drawing" style="--share: {drawing.width:g}">{svg}')
            return [head, *element["c"][1], raw_block("html", "</figure>")]
        case "Div" if "solution" in classes(element):
            label = plain([{"t": "Strong", "c": [{"t": "Str", "c": "Solution"}]}])
            return [{**element, "c": [element["c"][0], [label, *element["c"][1]]]}]
    return None
