"""Shaders and node files that change while the editor runs, in a process of its own on a copy of them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

BEGIN = """
import sys
from pathlib import Path
import numpy as np
from gui_driver import drive
from halation.authoring.edits.element_id import ElementId
from halation import document
from halation.authoring.commands import SetValue
from halation.editor.problems.findings import list_problems
from halation.graph import Graph, Output, Port, Settings, Unknown
from halation.nodes import Kind, Node, catalogue
from halation.resources.sandbox import UNRESTRICTED

here = Path(sys.argv[1])
nodes, shaders, path = here / "halation" / "nodes", here / "halation" / "shaders", here / "graph.json"
known = catalogue()
graph = Graph(settings=Settings((64, 36)), outputs={"image": Output(Kind.IMAGE)})
graph = graph.add("fill", known["constant"]()).add("light", known["exposure"](stops=1.0))
graph = graph.connect(Port("fill", "out"), Port("light", "image"))
graph = graph.connect(Port("light", "out"), Port("outputs", "image"))
document.save(graph, path, sandbox=UNRESTRICTED)

def brightness(ui):
    return ui.ask(lambda: float(ui.editor.probe.read_pixel(ui.editor.preview.find_whole_image("A").texture, 3, 3)[0]))

def problems(ui):
    return [one.sentence for one in list_problems(ui.window._contexts.problems)]
"""


@pytest.fixture
def script(tmp_path: Path) -> Callable[[str], None]:
    """`script(code)` drives the editor with `body(ui)` of the code; what is installed is not seen."""
    for top in ("nodes", "shaders"):
        shutil.copytree(ROOT / top, tmp_path / "halation" / top, ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "halation" / "presets").symlink_to(ROOT / "presets")
    for part in (ROOT / "app").iterdir():
        if part.name != "__pycache__":
            (tmp_path / "halation" / part.name).symlink_to(part)

    def run(code: str) -> None:
        path = os.pathsep.join(
            [
                str(tmp_path),
                str(ROOT / "tests"),
                sysconfig.get_path("purelib"),
                sysconfig.get_path("platlib"),
            ]
        )
        words = [sys.executable, "-S", "-P", "-c", f"{BEGIN}{code}\ndrive(body, here, path)\n", str(tmp_path)]
        result = subprocess.run(
            words,
            env={**os.environ, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"},
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=100,
        )
        assert result.returncode == 0, result.stdout + result.stderr

    return run


def test_a_shader_is_changed_broken_and_mended(script) -> None:
    script("""
def body(ui):
    ui.settled()
    first, good = brightness(ui), shader.read_text()
    shader.write_text(good.replace("exp2(", "3.0 * exp2("))
    ui.until(lambda: abs(brightness(ui) - 3.0 * first) < 1e-4)
    shown = ui.editor.preview.find_whole_image("A")
    shader.write_text(good + "\\nvec4 broken( { nonsense }\\n")
    ui.until(lambda: any("color/exposure.glsl, line" in one for one in problems(ui)))
    assert "light" in ui.editor.preview.faults
    ui.wait(5)
    assert ui.editor.preview.find_whole_image("A").key == shown.key and abs(brightness(ui) - 3.0 * first) < 1e-4
    shader.write_text(good.replace("exp2(", "5.0 * exp2("))
    ui.until(lambda: abs(brightness(ui) - 5.0 * first) < 1e-4)
    assert not problems(ui)
    shader.unlink()
    ui.until(lambda: any("exposure" in one for one in problems(ui)))
    shader.write_text(good)
    ui.until(lambda: not problems(ui) and abs(brightness(ui) - first) < 1e-4)
    assert not ui.session.dirty and not ui.session.history.can_undo

shader = shaders / "color" / "exposure.glsl"
""")


def test_a_node_file_is_changed_broken_and_removed(script) -> None:
    script("""
def body(ui):
    ui.settled()
    good, text = file.read_text(), path.read_text()
    ui.session.apply(SetValue(Port("light", "stops"), 2.0))
    ui.session.select([ElementId("light")])
    file.write_text(good.replace("stops:", "gain: Annotated[float, Slider(0.0, 9.0, unit='ratio')] = 7.0\\n    stops:"))
    ui.until(lambda: "field light.gain" in ui.editor.places)
    assert ui.session.graph.value(Port("light", "gain")) == 7.0
    assert ui.session.graph.value(Port("light", "stops")) == 2.0
    ui.session.apply(SetValue(Port("light", "gain"), 3.0))
    ui.session.undo()
    assert ui.session.graph.value(Port("light", "gain")) == 7.0

    kept = ui.session.root
    file.write_text(good + "\\nthis is no python\\n")
    ui.until(lambda: any("nodes/color/exposure.py, line" in entry.sentence for entry in ui.editor.log.entries))
    assert ui.session.root is kept

    file.write_text(good)
    ui.until(lambda: "field light.gain" not in ui.editor.places)
    assert ui.session.graph.value(Port("light", "stops")) == 2.0

    file.unlink()
    ui.until(lambda: isinstance(ui.session.root.nodes["light"], Unknown))
    ui.settled()
    assert any("exposure" in one for one in problems(ui))
    ui.session.files.save()
    assert '"stops": 2.0' in path.read_text() and '"type": "exposure"' in path.read_text()
    ui.session.undo()
    file.write_text(good)
    ui.until(lambda: isinstance(ui.session.root.nodes["light"], Node))
    ui.settled()
    assert not problems(ui) and ui.session.graph.value(Port("light", "stops")) == 1.0
    ui.session.redo()
    assert ui.session.graph.value(Port("light", "stops")) == 2.0

file = nodes / "color" / "exposure.py"
""")
