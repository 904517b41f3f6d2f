"""The lengths that the manual promises for code, to the letter and the line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from halation.custom_nodes.code import CodeFault
from halation.custom_nodes.securing import check_length

MANUAL = (Path(__file__).parents[2] / "docs/shaders.md").read_text("utf-8")


def find_promised() -> tuple[int, int]:
    """Letters and lines of a text, as the table of limits has them."""
    row = re.search(r"^\| the text \| ([\d,]+) letters, ([\d,]+) lines \|$", MANUAL, re.MULTILINE)
    assert row is not None
    letters, lines = (int(number.replace(",", "")) for number in row.groups())
    return letters, lines


def test_as_many_letters_and_lines_as_the_manual_says() -> None:
    letters, lines = find_promised()
    for text in ("a" * letters, "\n" * lines, "\n" * lines + "a" * (letters - lines)):
        check_length(text)
        with pytest.raises(CodeFault, match="the code has more than 1000000 letters or 50000 lines"):
            check_length(text + text[-1])
