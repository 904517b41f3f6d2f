"""Files of nodes that change while the editor runs, on a copy of the project in a process of its own."""

from __future__ import annotations

import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Annotated

import pytest
from halation.graph import Graph, Group, Port, Unknown
from halation.nodes import Image, Pointwise, Slider, catalogue
from halation.watch.reloading import migrate_graph, shader_folder

ROOT = Path(__file__).parents[2]

BEGIN = """
from pathlib import Path
from halation import document
from halation.watch.reloading import NodeFiles, migrate_graph
from halation.graph import Graph, Unknown
from halation.nodes import Node, catalogue

files, before = NodeFiles(), catalogue()
color = files.folder / "color"
exposure = color / "exposure.py"
text = exposure.read_text()
graph = Graph().add("e", before["exposure"](stops=2.0)).add("s", before["saturation"](saturation=0.5))
assert files.reload() == "" and catalogue() is before and migrate_graph(graph) is graph
"""


@pytest.fixture
def script(tmp_path):
    """`script(code)` runs code with a copy of the project; what is installed is not seen."""
    package = tmp_path / "halation"
    for top, folder in (("app", package), *((top, package / top) for top in ("nodes", "shaders", "presets"))):
        shutil.copytree(ROOT / top, folder, ignore=shutil.ignore_patterns("__pycache__"))

    def run(code):
        path = f"{tmp_path}:{sysconfig.get_path('purelib')}:{sysconfig.get_path('platlib')}"
        words = [sys.executable, "-S", "-P", "-c", BEGIN + code]
        result = subprocess.run(words, env={"PYTHONPATH": path}, cwd=tmp_path, capture_output=True, text=True)
        assert result.returncode == 0, result.stderr

    return run


def test_a_changed_node(script):
    script("""
more = 'gain: Annotated[float, Slider(0.0, 9.0, unit="ratio")] = 7.0\\n    stops:'
exposure.write_text(text.replace("= 0.0", "= 1.0").replace("-10.0", "-30.0").replace("stops:", more))
assert files.reload() == ""
after = catalogue()
assert after["exposure"] is not before["exposure"] and after["saturation"] is before["saturation"]
assert after["exposure"].values["stops"].low == -30.0 and list(after) == list(before)
new = migrate_graph(graph)
assert isinstance(new.nodes["e"], Node) and type(new.nodes["e"]) is after["exposure"]
assert (new.nodes["e"].stops, new.nodes["e"].gain) == (2.0, 7.0) and new.nodes["s"] is graph.nodes["s"]
assert document.loads(document.dumps(new), sandbox=None) == new
# Twice within a second, and of the same length: the compiled file of the first must not be taken for the second.
for number in (3, 4):
    exposure.write_text(text.replace("= 0.0", f"= {number}.0"))
    assert files.reload() == "" and catalogue()["exposure"]().stops == number
assert migrate_graph(new).nodes["e"].stops == 2.0
""")


def test_a_broken_file_changes_nothing(script):
    script("""
cases = {
    text.replace("Exposure(Pointwise):", "Exposure(Pointwise)"): "nodes/color/exposure.py, line 6: expected ':'",
    text.replace("-10.0, 10.0", "-10.0, nothing"): "line 14: name 'nothing' is not defined",
    text.replace("float, Slider", "dict, Slider"): "nodes/color/exposure.py, line 6: ",
    "raise SystemExit": "line 1: SystemExit",
    "from . import gone": "line 1: ",
    "\\x00": "",
}
for broken, said in cases.items():
    exposure.write_text(broken)
    fault = files.reload()
    assert said in fault and fault.endswith("; all nodes stay as they were"), fault
    assert catalogue() is before and before["exposure"](stops=1.0).identity() is None
(color / "fresh.py").write_text("1 +")
exposure.write_text(text)
assert "nodes/color/fresh.py, line 1" in files.reload() and catalogue() is before
(color / "fresh.py").unlink()
assert files.reload() == "" and catalogue() is before
""")


def test_new_and_removed_nodes(script):
    script("""
(files.folder / "mine").mkdir()
(files.folder / "mine" / "__init__.py").touch()
(files.folder / "mine" / "glowing.py").write_text(text.replace("Exposure", "Glowing"))
exposure.unlink()
old = Graph().add("g", Unknown("glowing", {"version": 1, "values": {"stops": 3.0, "odd": 1}}))
assert files.reload() == ""
assert catalogue()["glowing"].category == "mine" and "exposure" not in catalogue()
alive = migrate_graph(old)
assert alive.nodes["g"].stops == 3.0 and alive.extra["nodes.g.values"] == {"odd": 1}
assert document.dumps(alive) == document.dumps(old)
gone = migrate_graph(graph)
assert gone.nodes["e"].type == "exposure" and document.dumps(gone) == document.dumps(graph)
exposure.write_text(text)
assert files.reload() == "" and migrate_graph(gone).nodes["e"].stops == 2.0
assert migrate_graph(gone) == migrate_graph(graph)
""")


def test_the_vocabulary_and_shared_files(script):
    script("""
(color / "_shared.py").write_text("START = 5.0")
exposure.write_text("from ._shared import START\\n" + text.replace("= 0.0", "= START"))
assert files.reload() == "" and catalogue()["exposure"]().stops == 5.0
(color / "_shared.py").write_text("START = 6.0")
assert files.reload() == "" and catalogue()["exposure"]().stops == 6.0
sockets = files.folder / "_declare" / "sockets.py"
sockets.write_text(sockets.read_text() + "\\n")
now = catalogue()
assert "start the editor again" in files.reload() and catalogue() is now
""")


class Exposure(Pointwise):
    """Like the one of the catalogue, with another default and a new version."""

    version = 2
    image = Image()
    stops: Annotated[float, Slider(0.0, 10.0, unit="EV")] = 3.0
    amount: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5

    @classmethod
    def upgrade(cls, version, values):
        return {"amount": values["amount"] / 2.0} if "amount" in values else values


class Saturation(Pointwise):
    """With another type of value."""

    image = Image()
    saturation: bool = True


TYPES = {**catalogue(), "exposure": Exposure, "saturation": Saturation}


def test_values_that_no_longer_fit_have_their_default_and_links_stay():
    graph = Graph().add("a", catalogue()["exposure"](stops=0.25)).add("b", catalogue()["saturation"](saturation=0.5))
    graph = graph.connect(Port("a", "out"), Port("b", "image")).mute("a")
    new = migrate_graph(graph, TYPES)
    assert dict(new.nodes) == {"a": Exposure(stops=0.25), "b": Saturation()}
    assert new.links == graph.links and new.muted == graph.muted


def test_versions_and_what_is_kept_aside():
    graph = Graph(extra={"nodes.a": {"note": 1}, "nodes.a.values": {"amount": 0.5, "odd": 2}, "nodes.ab": {"other": 3}})
    graph = graph.add("a", catalogue()["exposure"](stops=4.0)).add("ab", catalogue()["saturation"]())
    new = migrate_graph(graph, TYPES)
    assert new.nodes["a"] == Exposure(amount=0.25)
    assert new.extra["nodes.a"] == {"note": 1} and new.extra["nodes.ab"] == {"other": 3}


def test_groups_are_followed_and_the_rest_is_the_same():
    inner = Graph().add("a", catalogue()["exposure"](stops=4.0)).add("same", catalogue()["grade"]())
    graph = Graph(folder="here").add("g", Group(inner, "body.json")).add("u", Unknown("odd", {"x": 1}))
    new = migrate_graph(graph, TYPES)
    group = new.nodes["g"]
    assert group.path == "body.json" and group.graph.nodes["a"] == Exposure(stops=4.0)
    assert group.graph.nodes["same"] is inner.nodes["same"] and new.nodes["u"] is graph.nodes["u"]
    assert new.folder == "here" and migrate_graph(new, TYPES) is new


def test_the_folder_of_shaders():
    assert (shader_folder() / "color" / "exposure.glsl").is_file()
