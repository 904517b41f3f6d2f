"""Problems as text for the clipboard, and their details, which open."""

from __future__ import annotations

import pytest
from halation.editor.problems.findings import ListedProblem
from halation.editor.problems.panel import problem_text


@pytest.mark.parametrize(
    ("problem", "text"),
    [
        (ListedProblem("error", "", "it is so"), "it is so"),
        (ListedProblem("error", "glow/blur", "it is so"), "glow/blur: it is so"),
        (ListedProblem("warning", "", "it is so", "line 1\nline 2"), "it is so\nline 1\nline 2"),
        (ListedProblem("warning", "glow", "it is so", "line 1"), "glow: it is so\nline 1"),
    ],
)
def test_what_is_copied_says_where_and_why(problem: ListedProblem, text: str) -> None:
    assert problem_text(problem) == text
