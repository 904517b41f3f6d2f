"""Everything that is done on the canvas by mouse and keyboard can be undone to the beginning, and done again."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from gui_canvas import chain, empty, row, show
from halation.document import dumps, save
from halation.graph import Port
from halation.resources.sandbox import UNRESTRICTED


@dataclass
class Record:
    """What the document was before and after each act."""

    ui: Any
    acts: list[tuple[str, tuple, tuple]] = field(default_factory=list)

    def state(self) -> tuple:
        session = self.ui.session
        return dumps(session.root), session.place, session.selection, session.active

    def act(self, name: str, do) -> None:
        """Do something that is one step."""
        before, steps = self.state(), self.ui.session.history.position
        do()
        assert _came(self.ui, steps), f"{name}: {[entry.sentence for entry in self.ui.editor.log.entries]}"
        self.ui.wait(3)
        assert self.ui.session.history.position == steps + 1, name
        self.acts.append((name, before, self.state()))


def _came(ui, steps: int) -> bool:
    """True once there is one more step; False if none comes."""
    for _ in range(60):
        if ui.session.history.position > steps:
            return True
        ui.wait(1)
    return False


def _same(found: tuple, wanted: tuple, what: str) -> None:
    assert found[1:] == wanted[1:], what
    assert found[0].splitlines() == wanted[0].splitlines(), what


def test_a_long_series_of_acts_is_undone_and_done_again(gui) -> None:
    def body(ui) -> None:
        show(ui, chain("exposure", "bloom", "clip"), 0.55)
        session, record = ui.session, Record(ui)
        first = session.history.position

        def title(key: str) -> None:
            ui.click(f"title {key}", fraction=(0.3, 0.5))
            ui.until(lambda: session.selection == {key})

        def press(name: str, keys: str) -> None:
            record.act(name, lambda: ui.keys(keys))

        def dragged(key: str, dx: float, dy: float, keys: str = "") -> None:
            x, y = ui.at(f"title {key}", (0.3, 0.5))
            ui.drag((x, y), (x + dx, y + dy), keys=keys)

        def add() -> None:
            ui.keys("Tab")
            ui.until(lambda: "search field" in ui.editor.places)
            ui.ctx.key_chars("vign")
            ui.wait(3)
            ui.keys("Enter")

        def named(text: str) -> None:
            ui.keys("F2")
            ui.wait(3)
            ui.type(text)

        ui.move(empty(ui))
        ui.wait(2)
        record.act("add", add)
        record.act("link", lambda: ui.drag("pin out exposure.out", "pin in vignette.image"))
        title("vignette")
        record.act("move", lambda: dragged("vignette", 30, 40))
        title("exposure")
        ui.move("widget exposure.stops")
        ui.wait(3)
        x, y = ui.at("widget exposure.stops")
        record.act("value", lambda: ui.drag((x, y), (x + 20, y)))
        assert session.graph.value(Port("exposure", "stops")) > 0.2
        press("mute", "M")
        title("bloom")
        press("collapse", "H")
        press("expand", "H")
        press("viewer", "Ctrl+3")
        press("frame", "Shift+F")
        record.act("frame title", lambda: named("Light"))
        ui.move(empty(ui))
        ui.wait(2)
        press("comment", "Shift+C")
        (note,) = session.selection
        ui.double_click(f"node {note}")
        ui.wait(4)
        ui.ctx.key_chars("Mind the gap")
        ui.wait(3)
        press("comment text", "Enter")
        x, y = ui.at("link clip.image")
        record.act("dot", lambda: ui.drag((x, y - 40), (x, y + 40), button=1, keys="Shift"))
        (dot,) = session.selection
        x, y = ui.at(f"node {dot}")
        record.act("move dot", lambda: ui.drag((x, y), (x, y + 30)))
        title("clip")
        record.act("extract", lambda: dragged("clip", 20, 130, "Alt"))
        assert session.graph.links[Port("outputs", "image")] == Port("bloom", "out")
        record.act("insert", lambda: ui.drag(ui.at("title clip", (0.5, 0.5)), "link outputs.image"))
        assert session.graph.links[Port("outputs", "image")] == Port("clip", "out")
        ui.editor.canvas.fit()
        ui.wait(4)
        title("clip")
        press("duplicate", "Ctrl+D")
        ui.keys("Ctrl+C")
        ui.move(empty(ui))
        ui.wait(2)
        press("paste", "Ctrl+V")
        (pasted,) = session.selection
        press("delete", "Delete")
        assert pasted not in session.graph.nodes
        title("bloom")
        press("group", "Ctrl+G")
        record.act("rename", lambda: named("glow"))
        ui.keys("Ctrl+Enter")
        ui.until(lambda: session.place == ("glow",))
        ui.wait(6)
        title("bloom")
        press("mute inside", "M")
        ui.keys("Ctrl+Backspace")
        ui.until(lambda: session.place == ())
        ui.wait(6)
        title("glow")
        press("ungroup", "Ctrl+Shift+G")
        x, y = ui.at("link exposure.image")
        record.act("cut", lambda: ui.drag((x, y - 40), (x, y + 40), button=1, keys="Ctrl"))
        ui.click(empty(ui))
        ui.keys("Ctrl+A")
        press("arrange", "L")
        press("delete all", "Delete")
        assert session.elements == ()

        for name, before, _ in reversed(record.acts):
            ui.keys("Ctrl+Z")
            _same(record.state(), before, f"undo of {name}")
        assert session.history.position == first
        for name, _, after in record.acts:
            ui.keys("Ctrl+Shift+Z")
            _same(record.state(), after, f"redo of {name}")

    gui(body, size=(1600, 1100))


def test_three_hundred_nodes_are_opened_selected_moved_deleted_and_brought_back(gui, tmp_path) -> None:
    path = tmp_path / "many.json"
    save(row(300), path, sandbox=UNRESTRICTED)

    def body(ui) -> None:
        session = ui.session
        ui.editor.store.change(thumbnails=False)
        assert len(session.graph.nodes) == 300
        ui.move("node n150")
        ui.keys("Home")
        ui.wait(4)
        assert sum(name.startswith("node n") for name in ui.editor.places) == 300
        ui.keys("Ctrl+A")
        ui.until(lambda: len(session.selection) == len(session.elements))
        before = dict(session.positions)
        x, y = ui.at("title n150")
        ui.drag((x, y), (x + 60, y + 40))
        by = {
            (round(session.positions[key][0] - at[0]), round(session.positions[key][1] - at[1]))
            for key, at in before.items()
        }
        assert len(by) == 1 and by != {(0, 0)}
        ui.keys("Delete")
        ui.until(lambda: not session.elements)
        ui.keys("Ctrl+Z")
        ui.keys("Ctrl+Z")
        assert dict(session.positions) == before
        assert sum(name.startswith("link n") for name in ui.editor.places) == 299

    gui(body, path)
