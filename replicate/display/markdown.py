"""Markdown with LaTeX math to HTML with MathML, in one pandoc call per page.

Starting pandoc costs more than converting a text, and a page holds hundreds of small texts (labels,
captions, explanations). So a text is only registered while the page is being rendered, which leaves a token
in its place; `MarkdownBatch.substitute` then converts all texts as one document and puts the results where
the tokens are.
"""

from __future__ import annotations

import html
import re
from typing import Literal

from markupsafe import Markup

from replicate.display.formulas import formulas, in_place, without_operators
from replicate.display.keeping import Keep, made_anew
from replicate.display.numbers import minus_signs
from replicate.display.pandoc import PandocError, SlowTextError, convert, refusal
from replicate.display.safe_html import sanitised
from replicate.errors import TemplateError, UnreadableFormulaError, UnreadableTextError

Form = Literal["block", "inline", "plain"]

# No heading ids: the page gives its own, and generated ones could clash with those of exhibits.
# "(5) and (6) give ..." is a sentence about equations, not item 5 of a list.
_LISTS = "-fancy_lists-example_lists"
# A "<" is a less-than sign: texts hold inequalities, and elements in them could break the page.
_NO_HTML = "-raw_html-native_divs-native_spans-markdown_in_html_blocks-raw_attribute"
# Attributes could carry handlers and styles; `sanitised` would remove them, but what is not read cannot slip through.
_NO_ATTRIBUTES = (
    "-bracketed_spans-fenced_divs-header_attributes-link_attributes-fenced_code_attributes-inline_code_attributes"
)
_FORMAT = f"markdown-auto_identifiers-implicit_figures-yaml_metadata_block{_LISTS}{_NO_HTML}{_NO_ATTRIBUTES}"
_OPTIONS = ("--mathml", "--wrap=none", "--fail-if-warnings", "--reference-location=block")
_LIMIT_ALONE = 5.0  # seconds for one paragraph
_MARKER = re.compile("<p>\ue004(\\d+)\ue005</p>")
_FORMULA = re.compile(r"Could not convert TeX math (.*?), rendering as TeX:?(.*)", re.DOTALL)
_TOKEN = re.compile("\ue000(block|inline|plain)(\\d+)\ue001")
_VERBATIM = re.compile(r"(<(?:code|pre|math)\b.*?</(?:code|pre|math)>|<[^>]*>)", re.DOTALL)
_SAID = re.compile(r'<math [^>]*?alttext="([^"]*)"[^>]*>.*?</math>', re.DOTALL)
_PER_CENT = re.compile(r"(?<=\d)\s?%(?!\w)")
_MARKS = re.compile("[\ue000-\ue007]")

#: Rooms of the framework whose code has texts converted, and what converts them: what a `Keep` of them looks at.
ROOMS = ("display/markdown", "display/pandoc")
DISTRIBUTIONS = ("pypandoc_binary",)


def without_marks(text: str) -> str:
    r"""Return a text in which the private characters that hold places of a page are written out.

    Examples
    --------
    >>> without_marks("\ue000block0\ue001")
    '\\ue000block0\\ue001'
    """
    return _MARKS.sub(lambda found: f"\\u{ord(found[0]):x}", text)


class MarkdownBatch:
    """Texts of one page that wait to be converted together.

    Examples
    --------
    >>> batch = MarkdownBatch("example")
    >>> page = f"<h1>{batch.inline('Is *this* true?')}</h1><a title='{batch.plain('*Yes*')}'>"
    >>> batch.substitute(page)
    "<h1>Is <em>this</em> true?</h1><a title='Yes'>"
    """

    def __init__(self, name: str, keep: Keep = made_anew) -> None:
        """Start an empty batch; `name` says in error messages which page the texts belong to."""
        self.name = name
        self._keep = keep
        self._texts: dict[str, int] = {}

    def block(self, text: str) -> Markup:
        """Register a text of paragraphs, headings and lists."""
        return self._token("block", text)

    def inline(self, text: str) -> Markup:
        """Register a text of one paragraph, to be placed inside another element."""
        return self._token("inline", _not_a_block(text))

    def plain(self, text: str) -> Markup:
        """Register a text for an attribute: converted, then stripped of all elements."""
        return self._token("plain", _not_a_block(text))

    def _token(self, form: Form, text: str) -> Markup:
        text = without_marks(text.strip())
        if not text:
            return Markup("")
        number = self._texts.setdefault(text, len(self._texts))
        return Markup(f"\ue000{form}{number}\ue001")  # noqa: S704 -- a token of two private-use characters

    def substitute(self, page: str) -> str:
        """Return the page with every token replaced by its converted text.

        Raises
        ------
        UnreadableFormulaError
            If a formula is not LaTeX that pandoc knows.
        UnreadableTextError
            If pandoc takes too long for a text.
        TemplateError
            If pandoc cannot convert a text for another reason.
        """
        converted = self._convert()

        def replacement(match: re.Match[str]) -> str:
            text = converted[int(match[2])]
            if match[1] == "block":
                return text
            inline = text.removeprefix("<p>").removesuffix("</p>") if text.count("<p>") == 1 else text
            return inline if match[1] == "inline" else html.escape(strip_elements(inline))

        return in_place(_TOKEN.sub(replacement, page))

    def _convert(self) -> list[str]:
        if not self._texts:
            return []
        marked = [f"\ue004{i}\ue005\n\n{text}\n" for text, i in self._texts.items()]
        source = "\n".join(marked)
        try:
            # What pandoc wrote is kept as it was, and made safe below each time: an entry is not trusted.
            document = self._keep(f"texts of {self.name}", lambda: convert(source, "html", _FORMAT, *_OPTIONS), source)
        except SlowTextError as error:
            raise UnreadableTextError(self.name, self._slowest(), str(error)) from error
        except PandocError as error:
            formula = _FORMULA.search(str(error))
            if formula:
                raise UnreadableFormulaError(self.name, formula[1].strip(), refusal(formula[2])) from error
            msg = f"{self.name}: pandoc cannot convert a text: {self._culprit(str(error))}"
            raise TemplateError(msg) from error
        # Every block has its own list of footnotes, and pandoc gives all of them the same id.
        document = sanitised(document).replace(' id="footnotes"', "")
        document = _typeset(formulas(document))
        parts = _MARKER.split(document)
        texts = dict(zip(map(int, parts[1::2]), parts[2::2], strict=True))
        for text, number in self._texts.items():
            if number not in texts:  # two unclosed fences, and what lies between them became code
                msg = f"{self.name}: a code fence is not closed in or before the text '{text[:60]}'"
                raise TemplateError(msg)
        return [texts[number].strip() for number in range(len(texts))]

    def _slowest(self) -> str:
        """Return the first paragraph for which pandoc takes too long when it stands alone."""
        for paragraph in (part for text in self._texts for part in re.split(r"\n\s*\n", text)):
            try:
                convert(paragraph, "html", _FORMAT, *_OPTIONS, limit=_LIMIT_ALONE)
            except SlowTextError:
                return paragraph
            except PandocError:
                continue
        return next(iter(self._texts))

    @staticmethod
    def _culprit(message: str) -> str:
        """Return the first two lines of pandoc's warning: what it is, and the LaTeX that caused it."""
        lines = [line.strip() for line in message.splitlines() if line.strip()]
        start = next((i for i, line in enumerate(lines) if "WARNING" in line or "rror" in line), 0)
        return " ".join(lines[start : start + 2])


def _not_a_block(text: str) -> str:
    """Escape what would make the first line of a text a list, heading, quotation or line block."""
    text = re.sub(r"^\s*(\d+)([.)]\s)", r"\1\\\2", text)
    return re.sub(r"^\s*([-+*#>|:]+\s)", r"\\\1", text)


def _typeset(document: str) -> str:
    """Return HTML whose numbers, but not those of code, addresses and formulas, have minus signs and stand off a "%".

    Examples
    --------
    >>> _typeset('<a href="x-1 -1">at -1</a> <code>a -1</code>')
    '<a href="x-1 -1">at −1</a> <code>a -1</code>'
    >>> _typeset('5% or 5 % of <code>5%</code>')
    '5\N{NO-BREAK SPACE}% or 5\N{NO-BREAK SPACE}% of <code>5%</code>'
    """
    parts = _VERBATIM.split(document)
    parts[::2] = [_PER_CENT.sub("\N{NO-BREAK SPACE}%", minus_signs(part)) for part in parts[::2]]
    return "".join(parts)


def strip_elements(text: str) -> str:
    """Return the text of an HTML fragment without its elements.

    Examples
    --------
    >>> strip_elements("<em>a</em> &lt; <math><mi>b</mi></math>")
    'a < b'
    >>> strip_elements('<math alttext="b²"><msup><mi>b</mi><mn>2</mn></msup></math>')
    'b²'
    """
    return without_operators(html.unescape(re.sub(r"<[^>]*>", "", _SAID.sub(r"\1", text)))).strip()
