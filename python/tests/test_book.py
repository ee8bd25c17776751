"""What the chapter of the book shows is what comes out."""

import contextlib
import io
import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "book" / "src" / "python.md"


def test_the_chapter_says_what_is_printed(monkeypatch: pytest.MonkeyPatch) -> None:
    """With UPDATE_BOOK it is written anew."""
    monkeypatch.chdir(ROOT)
    text, names = PAGE.read_text(), {}

    def printed(block: re.Match) -> str:
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            exec(block[1], names)
        return f"```python\n{block[1]}```\n\n```text\n{output.getvalue()}```\n"

    run, blocks = re.subn(r"```python\n(.*?)```\n\n```text\n.*?```\n", printed, text, flags=re.DOTALL)
    assert blocks == text.count("```python")
    if "UPDATE_BOOK" in os.environ:
        PAGE.write_text(run)
    else:
        assert run == text
