"""Values that hold named items (lights, outlines, strokes, pairs of curves): what is said of them."""

from __future__ import annotations

import json

import pytest
from halation.editor.fields.item_facts import describe_count
from halation.graph.names import name_fault
from halation.graph.scalars import describe_type
from halation.graph.values import coerce, value_fault
from halation.nodes import ItemSet, Value, catalogue

NOUNS = {
    "light": "lights",
    "light group": "light groups",
    "pair of curves": "pairs of curves",
    "shape": "shapes",
    "stroke": "strokes",
}
VALUES = {value.items.noun: value for node in catalogue().values() for value in node.values.values() if value.items}


def example(value: Value) -> ItemSet:
    words, _, shown = describe_type(value).partition(" by name, such as ")
    assert value.items is not None and words == NOUNS[value.items.noun]
    return coerce(value, json.loads(shown))


def test_each_noun_has_words_here():
    assert VALUES.keys() == NOUNS.keys()


@pytest.mark.parametrize("noun", NOUNS)
def test_the_example_of_a_fault_is_a_value(noun):
    (name,) = example(VALUES[noun])
    assert name_fault(name, noun) is None


@pytest.mark.parametrize("noun", NOUNS)
def test_more_than_one_are_named_in_plain_english(noun):
    value = VALUES[noun]
    assert value.items is not None
    items = {f"{noun}_{number}": {"kind": value.items.kinds[0].name} for number in range(value.items.most + 1)}
    fault = value_fault(value, items) or ""
    assert fault.startswith(f"{value.items.most + 1} {NOUNS[noun]} are too many"), fault
    (item,) = example(value).values()
    counts = [describe_count(ItemSet({f"item{number}": item for number in range(count)}), noun) for count in range(3)]
    assert counts == [f"no {NOUNS[noun]}", f"1 {noun}", f"2 {NOUNS[noun]}"]
