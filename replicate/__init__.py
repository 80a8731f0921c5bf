"""Reproducible replications of papers: which printed numbers can be trusted, and why not the others.

Importing this package loads nothing else: take the numerical core from `replicate.loops`.
"""

TYPE_CHECKING = False  # type checkers know it by its name; importing `typing` would cost ten times the rest
if TYPE_CHECKING:
    __version__: str
else:

    def __getattr__(name: str) -> str:
        # Looked up on demand: importlib.metadata alone would double the import time.
        if name != "__version__":
            msg = f"module {__name__!r} has no attribute {name!r}"
            raise AttributeError(msg)
        from importlib.metadata import PackageNotFoundError, version

        try:
            return version("paper-replicate")
        except PackageNotFoundError:  # imported from a checkout that is not installed
            return "unknown"
