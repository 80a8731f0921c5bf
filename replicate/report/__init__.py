"""The HTML report: an overview and one page per paper, readable without a network, a server or a script."""
