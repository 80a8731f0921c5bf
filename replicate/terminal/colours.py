"""The colours of verdicts on a terminal; a symbol always goes with them."""

_COLOURS = {
    "reproduced": "green",
    "consistent": "green",
    "reconstructed": "cyan",
    "near": "yellow",
    "misprint": "magenta",
    "damaged": "magenta",
    "discrepant": "magenta",
    "unexplained": "red",
    "not-computable": "dim",
    "holds": "green",
    "holds-partly": "yellow",
    "undecided": "dim",
    "fails": "red",
    "done": "green",
    "partly": "yellow",
}


def colour(word: str) -> str:
    """Return the style of a verdict or status; plain text for any other word."""
    return _COLOURS.get(word, "")
