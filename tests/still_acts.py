"""A still editor with something of everything, what an act may change in it, and acts on all that it shows."""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator
from pathlib import Path

from gui_renders import make_render
from halation import document
from halation.authoring.commands import AnimateValues, SetFrameRange, SetValue
from halation.graph import Graph, Key, Keys, Output, Port
from halation.nodes import Kind, catalogue
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor

STARTING = "render", "export write", "export start", "export"
"""Buttons that write files."""

LEFT_ALONE = ("open folder", "button file.", "menu ", "cancel", "again", "play")
"""Places whose clicks start programs, or ask the system."""

SIZES = "ui_scale", "panel"
"""What has another size on a larger interface."""

PLAIN = str, bool, int, float, tuple, set, frozenset


def make_graph() -> Graph:
    graph = Graph().add_output("image", Output(Kind.IMAGE, 4))
    for id in ("noise", "bloom", "vignette"):
        graph = graph.add(id, catalogue()[id]())
    for source, target in (("noise.out", "bloom.image"), ("bloom.out", "outputs.image")):
        graph = graph.connect(Port.parse(source), Port.parse(target))
    return graph


def describe(still: StillEditor) -> dict[str, object]:
    """What an act may have changed."""
    editor, session = still.editor, still.editor.session
    states = {"viewer": editor.viewer, "curves": editor.curves, "preferences": editor.store.current}
    facts: dict[str, object] = {
        f"{owner} {name}": repr(value)
        for owner, state in states.items()
        for name in state.__struct_fields__
        if isinstance(value := getattr(state, name), PLAIN) and not isinstance(value, float) and name not in SIZES
    }
    return facts | {
        "document": json.loads(document.dumps(session.root)),
        "steps": len(session.history.steps),
        "selected": sorted(session.selection),
        "frame": session.time.frame,
        "dialogs": (editor.dialogs.browse is not None, sorted(editor.dialogs.open), editor.dialogs.matches),
        "clipboard": imgui.get_clipboard_text(),
        "typing": imgui.get_io().want_text_input,
        "exports": [render.state for render in editor.exports.all],
        "words": sorted(still.pane.list_texts()),
        "places": sorted(editor.places),
    }


def prepare(still: StillEditor) -> None:
    """Something of everything."""
    session, folder = still.editor.session, Path("/pictures/shots/0120")
    still.editor.log.clock = lambda: 1e9
    session.apply(SetValue(Port("bloom", "intensity"), 0.9))
    session.apply(SetFrameRange(1, 48))
    session.apply(AnimateValues({Port("bloom", "knee"): Keys((Key(1, 0.2), Key(12, 0.9), Key(40, 0.1)))}, "Animate"))
    still.select("bloom")
    for level in ("info", "warning", "error"):
        still.editor.log.add(f"a message that is an {level}", level)
    still.editor.exports.all = (
        make_render(folder / "comp_v012.####.exr", "done", 24, notes=("image: clipped to 16 bit",)),
        make_render(folder / "comp_v013.png", "failed", total=1, sentence="/pictures/shots/0120: no such folder"),
        make_render(folder / "comp_v016.####.exr", "waiting"),
    )


def open_prepared(
    folder: Path, title: str, dialog: str = "", scale: float = 1.0, at: tuple[float, float] = (20.0, 30.0)
) -> Iterator[StillEditor]:
    """One such editor, with a panel or a dialog drawn."""
    shutil.rmtree(folder / "state", ignore_errors=True)
    with open_still_editor(folder, make_graph(), scale=scale, at=at, size=(900.0, 700.0)) as still:
        prepare(still)
        still.editor.dialogs.open |= {dialog} - {""}
        still.show(title)
        yield still


def list_clicked(still: StillEditor, title: str) -> list[str]:
    """The places of a panel that can be clicked without harm."""
    return sorted(
        place for place in still.places if not place.startswith(LEFT_ALONE) and place not in (title, *STARTING)
    )
