"""The HTML report: an overview and one page per paper, readable without a network, a server or a script."""

from replicate.report.pages import build_report

__all__ = ["build_report"]
