"""What a run has signed it knows again; what others may have written, or may know the key of, is worth nothing."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from replicate.run.signing import FILE, is_signed, signature


@pytest.fixture
def key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return where the user's key will be."""
    monkeypatch.setattr("replicate.run.signing.user_folder", lambda: tmp_path / "replicate")
    return tmp_path / "replicate" / FILE


def test_a_signature_is_of_its_content_alone(key: Path) -> None:
    given = signature(b"note")
    assert is_signed(b"note", given)
    assert not is_signed(b"Note", given)
    assert not any(is_signed(b"note", other) for other in ("", "é", None, 1, given[:-1]))
    assert [path.name for path in key.parent.iterdir()] == [FILE]


@pytest.mark.skipif(sys.platform == "win32", reason="files have no such mode there")
def test_a_key_that_others_can_read_is_none(key: Path) -> None:
    given = signature(b"note")
    assert key.stat().st_mode & 0o077 == 0
    key.chmod(0o644)
    assert not signature(b"note")
    assert not is_signed(b"note", given)
    assert not is_signed(b"note", "")


def test_a_damaged_key_is_none(key: Path) -> None:
    signature(b"note")
    key.write_bytes(b"short")
    assert not signature(b"note")


def test_another_key_signs_otherwise(key: Path) -> None:
    given = signature(b"note")
    key.unlink()
    assert signature(b"note")
    assert not is_signed(b"note", given)


def test_nobody_at_home_signs_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("replicate.run.signing.user_folder", lambda: None)
    assert not signature(b"note")
    assert not is_signed(b"note", "")
