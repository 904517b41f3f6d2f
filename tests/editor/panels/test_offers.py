"""What the palette, the sheet of shortcuts and the list of problems hold."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast, get_args

import pytest
from halation.authoring.commands import Disconnect, MakeGroup
from halation.authoring.log import Log
from halation.authoring.preferences import TYPES, PreferenceStore
from halation.authoring.session import Session
from halation.editor.command_palette.commands import list_commands, rank_commands
from halation.editor.preferences.shortcut_changes import assign_shortcut, reset_shortcut, take_shortcut
from halation.editor.problems.findings import list_problems, show_element
from halation.editor.shared.action import Action, Actions
from halation.editor.shared.keymaps import KEYMAPS
from halation.editor.shared.shortcut_groups import balance_columns, condense_rows, group_actions
from halation.editor.shared.stage import DocumentStage
from halation.editor.toolkit.context import Interface
from halation.editor.toolkit.keys import chord, text
from halation.editor.window.contexts import Contexts, compose_contexts
from halation.editor.window.editor import Editor
from halation.graph import Port
from halation.presets import paths
from halation.resources.sandbox import UNRESTRICTED

PRESET = next(path for path in paths() if path.stem == "soft_bloom")


@pytest.fixture
def desk(tmp_path: Path) -> Editor:
    """An editor whose pictures and files are left out."""
    store = PreferenceStore(tmp_path)
    none = cast(Any, None)
    preview, recovery, watcher = (
        cast(Any, SimpleNamespace(fault="", faults={}, errors={}, find_rivals=str)) for _ in range(3)
    )
    log = Log()
    actions = Actions(lambda: store.current.shortcuts, log, lambda: KEYMAPS[store.current.keymap])
    return Editor(
        DocumentStage(Session(sandbox=UNRESTRICTED)),
        preview,
        store,
        actions,
        recovery,
        none,
        none,
        none,
        Interface(store),
        exports=none,
        watcher=watcher,
        renders=none,
        coloring=none,
        passes=none,
        strip=none,
        node_timer=none,
        log=log,
    )


@pytest.fixture
def contexts(desk: Editor) -> Contexts:
    """What its panels receive."""
    return compose_contexts(desk)


def first(contexts: Contexts, query: str) -> str:
    return rank_commands(query, list_commands(contexts.command_palette), ())[0][0].label


def test_every_shortcut_can_be_pressed_and_is_written_in_one_way(desk: Editor, contexts: Contexts) -> None:
    assert [one.id for one in desk.actions.all if one.shortcut and text(chord(one.shortcut)) != one.shortcut] == []


@pytest.mark.parametrize("keymap", KEYMAPS)
def test_no_two_actions_share_a_shortcut(desk: Editor, contexts: Contexts, keymap: str) -> None:
    desk.store.change(keymap=keymap)
    pressed = {action.id: desk.actions.shortcut(action.id) for action in desk.actions.all}
    assert not {id: clash for id, keys in pressed.items() if (clash := desk.actions.conflicts(id, keys))}


@pytest.mark.parametrize("keymap", KEYMAPS)
def test_every_keymap_is_complete(desk: Editor, contexts: Contexts, keymap: str) -> None:
    """It names actions that exist, by keys that can be pressed, and no action that has a key loses it."""
    ids = {action.id for action in desk.actions.all}
    assert KEYMAPS[keymap].keys() <= ids and get_args(TYPES["keymap"]) == tuple(KEYMAPS)
    assert all(text(chord(keys)) == keys for keys in KEYMAPS[keymap].values())
    desk.store.change(keymap=keymap)
    assert not [action.id for action in desk.actions.all if action.shortcut and not desk.actions.shortcut(action.id)]
    reserved = {"Ctrl+Tab", "Ctrl+Shift+Tab"}  # the window library goes through panels with them
    assert not reserved & {desk.actions.shortcut(id) for id in ids}


def test_the_page_for_users_of_other_programs_has_these_keys(desk: Editor, contexts: Contexts) -> None:
    page = (Path(__file__).parents[3] / "docs" / "coming-from.md").read_text(encoding="utf-8")
    head, *rows = page.partition("| action | ")[2].partition("\n\n")[0].splitlines()
    names = [name.strip().lower() for name in head.strip("|").split("|")]
    ids = {action.label: action.id for action in reversed(desk.actions.all)}
    for row in rows[1:]:
        label, *keys = (cell.strip() for cell in row.strip("|").split("|"))
        for name, pressed in zip(names, keys, strict=True):
            desk.store.change(keymap=name)
            assert desk.actions.shortcut(ids[label]) == pressed, (label, name)
    assert len(rows) > 10 and names == list(KEYMAPS)


def test_a_keymap_is_what_users_of_that_program_press(desk: Editor, contexts: Contexts) -> None:
    """Spot checks against the manuals of the programs."""
    manuals = {
        "nuke": {"node.mute": "D", "node.add": "Tab", "layout.arrange": "L", "frame.add": "Alt+B"},
        "blender": {"node.add": "Shift+A", "node.mute": "M", "group.make": "Ctrl+G", "view.maximize": "Ctrl+Space"},
        "fusion": {"node.add": "Shift+Space", "node.mute": "Ctrl+P", "node.view": "1", "time.play": "Space"},
    }
    for keymap, keys in manuals.items():
        desk.store.change(keymap=keymap)
        assert {id: desk.actions.shortcut(id) for id in keys} == keys


def test_own_shortcuts_stand_above_the_keymap(desk: Editor, contexts: Contexts) -> None:
    desk.store.change(keymap="nuke")
    assign_shortcut(contexts.preferences, "node.mute", "Ctrl+M")
    assert desk.actions.shortcut("node.mute") == "Ctrl+M"
    reset_shortcut(contexts.preferences, "node.mute")
    assert desk.actions.shortcut("node.mute") == "D" and not desk.store.current.shortcuts
    sheet = {action.id for _, group in group_actions(desk.actions) for action in group}
    assert "link.dots" in sheet  # it has a key in Nuke only


def test_a_few_letters_find_actions_nodes_presets_and_places(desk: Editor, contexts: Contexts) -> None:
    desk.session.files.open(PRESET)
    assert first(contexts, "save as") == "Save As"
    assert first(contexts, "gb") == "Add Gaussian Blur"
    assert first(contexts, "open preset night") == "Open Preset Night Street"
    assert first(contexts, "go bloom") == "Go to bloom"


def test_what_cannot_be_done_says_why_and_comes_last(contexts: Contexts) -> None:
    offered = {command.id: command for command in list_commands(contexts.command_palette)}
    assert offered["edit.undo"].reason == "nothing to undo"
    assert offered["edit.copy"].reason == "select something first"
    assert not offered["file.open"].reason
    found = [bool(command.reason) for command, _ in rank_commands("o", tuple(offered.values()), ())]
    assert found == sorted(found)
    assert any(found)


def test_what_was_used_last_comes_first(contexts: Contexts) -> None:
    offered = list_commands(contexts.command_palette)
    found = [one.id for one, _ in rank_commands("", offered, ("file.open", "file.save_as"))]
    assert found[:2] == ["file.save_as", "file.open"]


def test_a_command_adds_a_node_where_the_pointer_is(desk: Editor, contexts: Contexts) -> None:
    desk.canvas.pointer = (300.0, 200.0)
    next(one for one in list_commands(contexts.command_palette) if one.id == "add bloom").run()
    (key,) = desk.session.selection
    assert desk.session.position(key) == (300.0, 200.0)


def test_taking_a_shortcut_over_and_giving_it_back(desk: Editor, contexts: Contexts) -> None:
    assert [one.id for one in desk.actions.conflicts("file.new", "Ctrl+O")] == ["file.open"]
    take_shortcut(contexts.preferences, "file.new", "Ctrl+O")
    assert desk.actions.shortcut("file.new") == "Ctrl+O"
    assert desk.actions.shortcut("file.open") == ""
    reset_shortcut(contexts.preferences, "file.open")
    assert desk.actions.shortcut("file.open") == "Ctrl+O"
    assert desk.actions.shortcut("file.new") == ""
    reset_shortcut(contexts.preferences, "file.new")
    assert desk.store.current.shortcuts == {}
    assign_shortcut(contexts.preferences, "file.new", "F5")
    assert desk.store.current.shortcuts == {"file.new": "F5"}


def test_the_same_keys_may_serve_two_panels() -> None:
    acts = (
        Action("a", "A", print, shortcut="A", scope="graph"),
        Action("b", "B", print, shortcut="A", scope="viewer"),
        Action("c", "C", print, shortcut="A"),
    )
    actions = Actions(dict, Log())
    actions.bind(acts, None)
    assert [one.id for one in actions.conflicts("a", "A")] == ["c"]
    assert [one.id for one in actions.conflicts("c", "A")] == ["a", "b"]


def test_the_sheet_has_every_shortcut_once(desk: Editor, contexts: Contexts) -> None:
    listed = [action.id for _, actions in group_actions(desk.actions) for action in actions]
    assert sorted(listed) == sorted(one.id for one in desk.actions.all if one.shortcut)
    assert len([1 for _, actions in group_actions(desk.actions, every=True) for _ in actions]) == len(desk.actions.all)


def test_rows_that_count_up_are_one_line() -> None:
    lines = [("F", "Fit"), *((str(at), f"View {at}") for at in range(1, 10)), ("Ctrl+1", "Keep 1"), ("0", "Full size")]
    assert condense_rows(lines) == (("F", "Fit"), ("1 - 9", "View 1 - 9"), ("Ctrl+1", "Keep 1"), ("0", "Full size"))


def test_columns_are_as_equal_as_order_allows() -> None:
    assert balance_columns((5, 5, 5, 5), 2) == ((0, 1), (2, 3))
    assert balance_columns((9, 1, 1, 1), 2) == ((0,), (1, 2, 3))
    assert balance_columns((), 3) == ()


def test_everything_that_is_wrong_is_listed_once(desk: Editor, contexts: Contexts) -> None:
    desk.session.files.open(PRESET)
    assert list_problems(contexts.problems) == ()
    desk.session.apply(Disconnect(Port("outputs", "image")))
    desk.preview.faults = {"inputs.beauty": "there is no such file", "outputs.image": "the same in other words"}
    desk.watcher.fault = desk.recovery.fault = "the disk is full"
    desk.faults["Viewer"] = "Traceback"
    found = [(one.level, one.where, one.sentence) for one in list_problems(contexts.problems)]
    assert ("error", "inputs.beauty", "there is no such file") in found
    assert ("error", "", "the panel Viewer failed; the document is safe") in found
    assert found[-1] == ("warning", "", "the disk is full")
    assert len(found) == 3 + sum(map(len, desk.session.problems.values()))
    assert sum(map(len, desk.session.problems.values())) > 0


def test_a_finding_leads_into_its_group(desk: Editor, contexts: Contexts) -> None:
    desk.session.files.open(PRESET)
    desk.session.select(["bloom"])
    group = desk.session.apply(MakeGroup())
    show_element(contexts.problems, f"{group}/bloom")
    assert desk.session.place == (group,)
    assert desk.session.selection == {"bloom"}
    assert desk.canvas.pending_fit == ("bloom",)
    show_element(contexts.problems, "inputs.beauty")
    assert desk.session.place == ()
    assert desk.session.selection == {"inputs.beauty"}


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("ssao", "Add Ambient Occlusion"),
        ("defocus", "Add Depth of Field"),
        ("keyer", "Add Chroma Key"),
        ("linear dodge", "Add Merge Plus"),
        ("god rays", "Add Light Shafts"),
    ],
)
def test_commands_are_found_by_the_words_of_other_programs(contexts: Contexts, words: str, expected: str) -> None:
    offered = list_commands(contexts.command_palette)
    found = [command.label.lower() for command, _ in rank_commands(words, offered, ())][:3]
    assert expected.lower() in found


def test_a_merge_mode_is_added_with_its_mode(desk: Editor, contexts: Contexts) -> None:
    next(one for one in list_commands(contexts.command_palette) if one.id == "merge multiply").run()
    assert [item.setting("mode") for item in desk.session.graph.nodes.values()] == ["multiply"]
