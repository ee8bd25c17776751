"""What the pages about the package show is what comes out."""

import contextlib
import io
import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BOOK = ROOT / "docs" / "book" / "src"
PAGES = (BOOK / "python.md", BOOK / "python-many.md", ROOT / "python" / "README.md")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_page_says_what_is_printed(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With UPDATE_BOOK it is written anew."""
    monkeypatch.chdir(ROOT)
    text, names = page.read_text(encoding="utf-8"), {}

    def printed(block: re.Match) -> str:
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            exec(block[1], names)
        return f"```python\n{block[1]}```\n\n```text\n{output.getvalue()}```\n"

    run, blocks = re.subn(r"```python\n(.*?)```\n\n```text\n.*?```\n", printed, text, flags=re.DOTALL)
    assert blocks == text.count("```python")
    if "UPDATE_BOOK" in os.environ:
        page.write_text(run, encoding="utf-8")
    else:
        assert run == text
