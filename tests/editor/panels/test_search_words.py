"""The search of the canvas knows what other programs call things."""

from __future__ import annotations

import pytest
from halation.authoring.library import PresetLibrary
from halation.editor.shared.entries import (
    GROUP,
    CatalogEntry,
    arrange_entries,
    code_entries,
    graph_entries,
    mode_entries,
    node_entries,
    preset_entries,
    rank_entries,
)
from halation.nodes import catalogue
from menu_words import MENU_WORDS

ENTRIES = (
    *node_entries(catalogue()),
    *mode_entries(catalogue()),
    *code_entries(),
    *preset_entries(PresetLibrary().list_presets()),
    *graph_entries(),
)


def describe(entry: CatalogEntry) -> str:
    return f"{entry.id}:{entry.title}" if entry.values else entry.id


@pytest.mark.parametrize(("program", "word", "wanted"), MENU_WORDS)
def test_a_word_of_a_menu_finds_its_node_among_the_first_three(program: str, word: str, wanted: str) -> None:
    first = [describe(entry) for entry in rank_entries(ENTRIES, word)[:3]]
    targets = [wanted] if ":" in wanted else wanted.split()
    assert set(first) & set(targets), f"{program}: {word} finds {first}, not {wanted}"


def test_there_are_two_hundred_words() -> None:
    assert len(MENU_WORDS) >= 200


@pytest.mark.parametrize("id", list(catalogue()))
def test_every_title_finds_its_node_first(id: str) -> None:
    assert rank_entries(ENTRIES, catalogue()[id].title)[0].id == id


def test_nodes_come_before_presets() -> None:
    for word in ("halation", "glow", "toon", "light", "night"):
        groups = [entry.category == GROUP for entry in rank_entries(ENTRIES, word)[:3]]
        assert groups == sorted(groups) and not groups[0], word


@pytest.mark.parametrize("words", ["ready graph", "added as a group", "where it enters", "a preset"])
def test_sentences_that_all_entries_share_are_not_searched(words: str) -> None:
    assert not [entry.title for entry in rank_entries(ENTRIES, words) if entry.category == GROUP]


def test_every_merge_mode_is_an_entry_of_its_own() -> None:
    for mode in catalogue()["merge"].values["mode"].choices:
        first = rank_entries(ENTRIES, f"merge {mode}")[0]
        assert (first.id, dict(first.values)) == ("merge", {"mode": mode})


def test_modes_are_listed_by_a_search_alone() -> None:
    listed = [entry for section in arrange_entries(ENTRIES, "") for entry in section.entries]
    assert not [entry for entry in listed if entry.values]
    assert [entry.id for entry in listed].count("merge") == 1
