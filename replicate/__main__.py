"""``python -m replicate`` is the same as ``replicate``."""

from replicate.cli import main

main()
