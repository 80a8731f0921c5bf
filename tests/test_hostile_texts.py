"""What a stranger's texts can do to a page: nothing, wherever they stand in a paper."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html.parser import HTMLParser

import pytest
from markupsafe import Markup
from payloads import PAYLOADS

from replicate.display.markdown import MarkdownBatch
from replicate.display.rendering import html_environment, render
from replicate.display.safe_html import sanitised
from replicate.errors import UnreadableFormulaError

TEXT = {
    "p", "em", "strong", "a", "code", "pre", "ul", "ol", "li", "blockquote", "table", "caption", "colgroup", "col",
    "thead", "tbody", "tfoot", "tr", "th", "td", "h1", "h2", "h3", "h4", "h5", "h6", "sub", "sup", "br", "hr", "del",
    "section", "dl", "dt", "dd", "span", "aside", "math", "mrow", "mi", "mn", "mo", "mtext", "div", "title",
}  # fmt: skip
ATTRIBUTES = {"id", "class", "href", "role", "start", "type", "display", "mathvariant", "scope", "title"}
SCHEMES = re.compile(r"(https?|mailto|doi):|#|[\w.%/]*(#|$)", re.IGNORECASE)


class Elements(HTMLParser):
    """The elements of a page with their attributes, as a browser that knows no mercy reads them."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str]]] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, {name: value or "" for name, value in attrs}))


def faults(page: str) -> Iterator[str]:
    for tag, attributes in Elements(page).found:
        if tag not in TEXT:
            yield f"<{tag}>"
        for name, value in attributes.items():
            if name not in ATTRIBUTES or (name == "href" and not SCHEMES.match(value.strip())):
                yield f"<{tag} {name}={value!r}>"


def converted(text: str) -> str:
    batch = MarkdownBatch("page")
    page = (
        f'<div>{batch.block("First.")}{batch.block(text)}</div><p title="{batch.plain(text)}">{batch.inline(text)}</p>'
    )
    return batch.substitute(page)


@pytest.mark.parametrize("text", PAYLOADS)
def test_a_text_becomes_text(text: str) -> None:
    try:
        page = converted(text)
    except UnreadableFormulaError as refused:
        assert "\n" not in str(refused)  # noqa: PT017  -- either refused in one line, or harmless
        return
    assert list(faults(page)) == []
    assert "First." in page  # no text takes the place of another


def test_the_list_of_faults_finds_what_a_page_must_not_hold() -> None:
    for page in ("<script>x</script>", "<p onclick=x>", "<a href='javascript:x'>", "<a href=' data:x'>", "<img src=x>"):
        assert list(faults(page)) != []


@pytest.mark.parametrize("text", PAYLOADS)
def test_html_as_such_is_cleaned(text: str) -> None:
    """The second wall, should the reader of Markdown ever let elements pass."""
    assert list(faults(sanitised(f"<p>{text}</p>"))) == []


@pytest.mark.parametrize("address", ["//example.org/x", "\\\\example.org\\x", " //example.org", "/\\example.org"])
def test_a_link_names_its_scheme_or_stays_in_the_report(address: str) -> None:
    assert "href" not in sanitised(f"<a href='{address}'>x</a>")


def test_texts_cannot_imitate_the_marks_of_a_page_that_is_being_filled() -> None:
    marks = [text for text in PAYLOADS if re.search("[\ue000-\ue007]", text)]
    assert len(marks) > 3
    for text in marks:
        page = html_environment().from_string("<p title='{{ text }}'>{{ text }}</p>").render(text=text)
        assert not re.search("[\ue000-\ue007]", page)
    batch = MarkdownBatch("page")
    page = (
        html_environment()
        .from_string("<p title='{{ a }}'>{{ b }}</p>")
        .render(a="\ue000block0\ue001", b=batch.block("x' onclick='hit()"))
    )
    assert Elements(batch.substitute(page)).found[0] == ("p", {"title": "\\ue000block0\\ue001"})


def test_a_page_has_one_policy_and_no_other_directions_for_the_browser() -> None:
    about = type(
        "About", (), {"methods": "\n\n".join(text for text in PAYLOADS if "$" not in text and "```" not in text)}
    )
    page = render("methods.html", "methods.html", about=about, verdicts=Markup(""))
    metas = [attributes for tag, attributes in Elements(page).found if tag == "meta"]
    policies = [meta["content"] for meta in metas if meta.get("http-equiv")]
    assert len(policies) == 1
    for directive in ("default-src 'none'", "script-src 'none'", "base-uri 'none'", "form-action 'none'"):
        assert directive in policies[0]
    assert "unsafe-inline" not in policies[0].replace("style-src-attr 'unsafe-inline'", "")
    assert not [tag for tag, _ in Elements(page).found if tag in {"script", "base", "link", "iframe", "object", "form"}]
