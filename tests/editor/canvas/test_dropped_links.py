"""Where a dragged link is let go says what is linked: a socket, all that are called alike, or nothing."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path

import pytest
from halation.graph import Graph, Port
from halation.nodes import catalogue
from imgui_bundle import imgui
from still_editor import StillEditor, open_still_editor


def make_graph() -> Graph:
    graph = Graph()
    for id in ("noise", "bloom", "vignette"):
        graph = graph.add(id, catalogue()[id]())
    return graph.connect(Port("noise", "out"), Port("bloom", "image"))


def drag(still: StillEditor, start: tuple[float, float], end: tuple[float, float], *, ctrl: bool = False) -> None:
    io = imgui.get_io()
    io.add_key_event(imgui.Key.mod_ctrl, ctrl)
    still.pane.point(start)
    still.show("Graph", 3)
    io.add_mouse_button_event(0, True)
    still.show("Graph", 1)
    for part in (0.3, 0.7, 1.0):
        still.pane.point((start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part))
        still.show("Graph", 2)
    io.add_mouse_button_event(0, False)
    still.show("Graph", 2)
    io.add_key_event(imgui.Key.mod_ctrl, False)
    still.show("Graph", 1)


def open_graph(tmp_path: Path, scale: float) -> AbstractContextManager[StillEditor]:
    return open_still_editor(tmp_path, make_graph(), size=(900.0, 700.0), scale=scale)


@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("target", ["vignette.mask", "bloom.mask"])
def test_a_link_goes_to_the_socket_that_it_is_dropped_on(tmp_path: Path, scale: float, target: str) -> None:
    with open_graph(tmp_path, scale) as still:
        still.show("Graph", 4)
        before = dict(still.editor.session.root.links)
        drag(still, still.find_point("pin out noise.value"), still.find_point(f"pin in {target}"))
        links = dict(still.editor.session.root.links)
        assert {port: source for port, source in links.items() if port not in before} == {
            Port.parse(target): Port("noise", "value")
        }


@pytest.mark.parametrize("ctrl", [False, True])
@pytest.mark.parametrize("is_alike", [False, True])
def test_a_socket_that_is_called_alike_brings_all_that_are(tmp_path: Path, ctrl: bool, is_alike: bool) -> None:
    """With Ctrl, and on a socket of another name, it comes alone."""
    render, light = catalogue()["read_render"], catalogue()["deferred_lighting"]
    graph = Graph().add("render", render()).add("light", light())
    alike = {name for name, socket in light.inputs.items() if name in render.outputs}
    target = "depth" if is_alike else "occlusion"
    with open_still_editor(tmp_path, graph, size=(1400.0, 1200.0)) as still:
        still.show("Graph", 4)
        drag(still, still.find_point("pin out render.depth"), still.find_point(f"pin in light.{target}"), ctrl=ctrl)
        linked = {port.socket for port in still.editor.session.root.links}
        assert linked == (alike if is_alike and not ctrl else {target}) and len(alike) > 2


def test_a_link_that_is_pulled_off_is_gone_and_one_step(tmp_path: Path) -> None:
    with open_graph(tmp_path, 1.0) as still:
        still.show("Graph", 4)
        session, steps = still.editor.session, still.editor.session.history.position
        start = still.find_point("pin in bloom.image")
        drag(still, start, (start[0] - 10.0, start[1] + 250.0))
        assert not session.root.links and session.history.position == steps + 1
        session.undo()
        assert {str(port) for port in session.root.links} == {"bloom.image"}


@pytest.mark.parametrize("length", [0.0, 1.0, 60.0])
def test_a_socket_that_is_only_clicked_is_shown_and_one_that_is_dragged_is_not(tmp_path: Path, length: float) -> None:
    with open_graph(tmp_path, 1.0) as still:
        still.show("Graph", 4)
        session, start = still.editor.session, still.find_point("pin out noise.vector")
        links = session.root.links
        drag(still, start, (start[0], start[1] + length))
        assert session.root.links == links
        is_shown = str(session.views.find_port("A")) == "noise.vector"
        assert is_shown is (length < 3.0)


def test_links_move_with_their_end(tmp_path: Path) -> None:
    """Dropped on another socket, the link is there and no longer here: in one step."""
    with open_graph(tmp_path, 1.0) as still:
        still.show("Graph", 4)
        session, steps = still.editor.session, still.editor.session.history.position
        drag(still, still.find_point("pin in bloom.image"), still.find_point("pin in vignette.image"))
        assert {str(port): str(source) for port, source in session.root.links.items()} == {
            "vignette.image": "noise.out"
        }
        assert session.history.position == steps + 1
