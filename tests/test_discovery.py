import re
from pathlib import Path

import pytest

import replicate.papers
from replicate.errors import PaperDefinitionError
from replicate.run.library import Library


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("1 +\n", "broken/__init__.py:1: invalid syntax"),
        ("\nimport no_such_module_at_all\n", "broken/__init__.py:2: ModuleNotFoundError: No module named 'no_such"),
        ("ratio = 1.0\nratio /= 0.0\n", "broken/__init__.py:2: ZeroDivisionError: float division by zero"),
    ],
)
def test_a_package_that_cannot_be_imported_is_named_with_file_and_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, message: str
) -> None:
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "__init__.py").write_text(code)
    monkeypatch.setattr(replicate.papers, "__path__", [str(tmp_path)])
    with pytest.raises(PaperDefinitionError, match=re.escape(f"replicate.papers.broken cannot be loaded: {message}")):
        Library().paper("broken")
