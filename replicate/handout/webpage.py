"""A handout as one web page: formulas as MathML, figures as inline SVG, nothing fetched, no script."""

from __future__ import annotations

import html
import re

from markupsafe import Markup

import replicate
from replicate.display.formulas import breakable, in_place
from replicate.display.function_names import references
from replicate.display.inline_svg import inline_svg
from replicate.display.rendering import html_environment, math_font
from replicate.display.source_code import highlight
from replicate.figures.style import dark_curves
from replicate.handout.edition import Document
from replicate.handout.pandoc import written
from replicate.handout.spoken_math import spoken
from replicate.handout.tree import Element, attribute, classes, plain, raw_block, raw_inline, string, transform
from replicate.plain_text import visible

TEMPLATE = "handout.html"
_LONGEST_LINE = 80  # characters of a program; one with a longer line scrolls, so the keyboard has to reach it
_EMPTY_HEAD = re.compile(r"<th\b([^>]*)></th>")


def webpage(document: Document) -> str:
    """Return the page as HTML."""
    blocks = transform(document.blocks, lambda element: _for_html(element, document))
    (body,) = written([blocks], "html", "--shift-heading-level-by=1")
    body = _EMPTY_HEAD.sub(r"<td\1></td>", in_place(body))  # a head without a name is none
    return visible(
        html_environment()
        .get_template(TEMPLATE)
        .render(
            title=document.title,
            paper=document.paper,
            solutions=document.solutions,
            language=document.language,
            words=document.sheet.language,
            date=document.sheet.date,
            form=document.form,
            dark_curves=dark_curves(),
            math_font=Markup(math_font()),  # noqa: S704  -- the project's own
            body=Markup(body),  # noqa: S704  -- the project's own text
            software=f"replicate {replicate.__version__}",
        )
    )


def _in_line(mathml: str, tex: str) -> str:
    """Return a formula in a line; a long one in pieces, each with its words, between which the line may end."""
    (content,) = re.findall("<semantics>(.*?)<annotation", mathml, re.DOTALL)
    pieces = breakable(content, tex)
    if len(pieces) == 1:
        return mathml
    said = [html.escape(spoken(f"<math>{piece}</math>")) for piece in pieces]
    return "".join(
        references(f'<math alttext="{words}" display="inline">{piece}</math>')
        for words, piece in zip(said, pieces, strict=True)
    )


def _for_html(element: Element, document: Document) -> list[Element] | None:
    """Replace formulas, programs and drawings by HTML; classes of everything else reach the style sheet."""
    match element["t"]:
        case "Math":
            kind, tex = element["c"]
            displayed = kind["t"] == "DisplayMath"
            mathml = document.formulas[displayed, tex].mathml
            return [raw_inline("html", mathml if displayed else _in_line(mathml, tex))]
        case "CodeBlock":
            code, names = element["c"][1], classes(element)
            text = highlight(code) if "python" in names else html.escape(code, quote=False)
            reach = ' tabindex="0"' if max(map(len, code.splitlines()), default=0) > _LONGEST_LINE else ""
            return [raw_block("html", f'<pre{reach} class="{" ".join(names)}"><code>{text}</code></pre>')]
        case "Div" if "drawing" in classes(element):
            drawing = document.drawings[attribute(element, "name")]
            svg = inline_svg(drawing.svg, f"svg-{drawing.name}", drawing.name, drawing.alt)
            head = raw_block("html", f'<figure class="drawing" style="--share: {drawing.width:g}">{svg}')
            return [head, *element["c"][1], raw_block("html", "</figure>")]
        case "Div" if "solution" in classes(element):
            label = plain([{"t": "Strong", "c": [string(document.sheet.language["solution"])]}])
            return [{**element, "c": [element["c"][0], [label, *element["c"][1]]]}]
    return None
