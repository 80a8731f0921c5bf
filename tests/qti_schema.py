"""The published schema of QTI 2.1, unpacked where a test may write."""

from __future__ import annotations

import zipfile
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import xmlschema


@cache
def schema() -> xmlschema.XMLSchema:
    """Return the schema; it fetches nothing."""
    with TemporaryDirectory() as folder:
        with zipfile.ZipFile(Path(__file__).with_name("schemas") / "qti-2.1.zip") as package:
            package.extractall(folder)
        return xmlschema.XMLSchema(str(Path(folder) / "qtiv2p1" / "imsqti_v2p1.xsd"), allow="local")


def faults(content: bytes) -> list[str]:
    """Return what the schema finds wrong in the items and the test of a package."""
    found = []
    with zipfile.ZipFile(BytesIO(content)) as package:
        names = [name for name in package.namelist() if name.endswith(".xml") and name != "imsmanifest.xml"]
        assert len(names) > 1
        for name in names:
            errors = schema().iter_errors(package.read(name).decode())
            found += [f"{name}: {error.path}: {error.reason}" for error in errors]
    return found
