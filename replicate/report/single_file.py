"""A paper as one file that can be mailed: all its pages in one, its data inside, and no link that leads nowhere."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from urllib.parse import quote

_LINK = re.compile(r'<a\b(?P<before>[^>]*?) href="(?P<address>[^"]*)"(?P<after>[^>]*)>(?P<text>.*?)</a>', re.DOTALL)
_AS_IT_IS = ",:;/()+=*~@!"  # what an address of data may hold, beside letters and digits
_BESIDES = re.compile(r"^(?:https?:|mailto:|doi:|#)")


def self_contained(page: str, own: Collection[str], files: Mapping[str, bytes]) -> str:
    """Return a page with its links turned inwards.

    Parameters
    ----------
    page
        HTML of the report's kind.
    own
        File names of the pages whose content it holds.
    files
        Data by address; a link to a table or to curves in CSV becomes the data themselves. Whatever else lies beside
        the page is no longer linked: other papers, lists of all papers, and pictures, which the page shows anyway.

    Examples
    --------
    >>> page = '<a href="p.html#a">A</a> <a href="index.html">all</a> <a href="data/t.csv" download>CSV</a>'
    >>> self_contained(page, {"p.html"}, {"data/t.csv": b"x"})
    '<a href="#a">A</a> all <a href="data:text/csv;charset=utf-8,x" download="t.csv">CSV</a>'
    """

    def inward(match: re.Match[str]) -> str:
        address, text = match["address"], match["text"]
        if _BESIDES.match(address):
            return match[0]
        file, _, fragment = address.partition("#")
        if file in own:
            return f'<a{match["before"]} href="#{fragment or "main"}"{match["after"]}>{text}</a>'
        if address in files and address.endswith(".csv"):
            content = quote(files[address], safe=_AS_IT_IS)  # a fifth shorter than base64
            name = address.rpartition("/")[2]
            return f'<a href="data:text/csv;charset=utf-8,{content}" download="{name}">{text}</a>'
        return "" if "download" in match["after"] else text

    return _LINK.sub(inward, page)
