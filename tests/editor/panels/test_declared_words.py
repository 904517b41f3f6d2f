"""What nodes, values and choices are called: headings of English have capital letters, those of German few."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from halation.editor.shared import declared_words as words
from halation.language.translation import use_language
from halation.nodes import catalogue


@pytest.fixture
def german() -> Iterator[None]:
    use_language("de")
    yield
    use_language("en")


def test_english_headings_have_a_capital_letter_in_each_word() -> None:
    assert (
        words.head_type("depth of field") == "Depth Of Field" and words.name_type("depth of field") == "depth of field"
    )
    assert words.raise_first("FXAA and more") == "FXAA and more" and words.raise_first("") == ""
    assert words.spell_out("light_trails_2") == "light trails 2"
    assert words.name_value("corner_left") == "corner left" and words.name_choices(["a b", "c"]) == ("a b", "c")


def test_german_headings_have_one(german: None) -> None:
    title = catalogue()["depth_of_field"].title
    name = words.name_type(title)
    assert name != title and words.head_type(title) == name[:1].upper() + name[1:]
    titles = [kind.title for kind in catalogue().values()]
    several = [title for title in titles if " " in words.name_type(title) != title]
    assert any(any(word[0].islower() for word in words.head_type(title).split()) for title in several)


def test_the_first_paragraph_sums_a_node_up() -> None:
    kind = catalogue()["bloom"]
    first, *rest = words.read_paragraphs(kind)
    assert words.summarize_type(kind) == first and words.describe_type(kind) == (first, *rest)
    assert "`" not in first and "\n" not in first and "  " not in first and first == " ".join(first.split())
