"""Where the files live that are not Python: the templates and the accepted state of every exhibit.

In a checkout both are folders at the top level, where people look for them. In an installed wheel they lie
inside the package, under the names that `pyproject.toml` gives them.
"""

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def templates_dir() -> Path:
    """Return the folder with the Jinja2 templates.

    Returns
    -------
    Path
        `replicate/_templates` of an installed wheel, otherwise `templates` of the checkout.

    Raises
    ------
    FileNotFoundError
        If neither exists, that is if the installation is damaged.

    Examples
    --------
    >>> templates_dir().is_dir()
    True
    """
    return _find("_templates", "templates")


def accepted_dir() -> Path:
    """Return the folder with the accepted state of the exhibits, one folder per paper.

    Returns
    -------
    Path
        `replicate/_figures` of an installed wheel, otherwise `figures` of the checkout.

    Raises
    ------
    FileNotFoundError
        If neither exists, that is if the installation is damaged.

    Examples
    --------
    >>> accepted_dir().is_dir()
    True
    """
    return _find("_figures", "figures")


def schemas() -> dict[str, str]:
    """Return the JSON Schemas of file formats by name, as texts.

    Examples
    --------
    >>> schemas().keys() >= {'project', 'ledger', 'printed'}
    True
    """
    files = sorted((_PACKAGE / "schemas").glob("*.schema.json"))
    return {file.name.removesuffix(".schema.json"): file.read_text(encoding="utf-8") for file in files}


def _find(packaged: str, checkout: str) -> Path:
    candidates = (_PACKAGE / packaged, _PACKAGE.parent / checkout)
    for candidate in candidates:
        if candidate.is_dir():
            return candidate
    tried = " nor ".join(str(candidate) for candidate in candidates)
    msg = f"the installation is damaged: there is neither {tried}"
    raise FileNotFoundError(msg)
