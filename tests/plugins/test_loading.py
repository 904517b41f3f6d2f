"""Plug-ins are found by their entry points; what is wrong with one of them costs only that one."""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from halation import document
from halation.compiler import load_library
from halation.errors import GraphError, ShaderError
from halation.graph import Graph, Port, Unknown, problems
from halation.nodes import catalogue, plugins
from halation.reference.specimen import plan_node
from halation.resources.sandbox import UNRESTRICTED

NODE = '''
from halation.nodes import Image, Pointwise, Slider
from typing import Annotated

class {name}(Pointwise):
    """Darken."""

    image = Image()
    factor: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5
'''


@dataclass
class Site:
    """A folder that Python imports from, in which packages can be installed."""

    folder: Path
    monkeypatch: pytest.MonkeyPatch

    def allow(self, package: str) -> None:
        """Let this package be loaded too; what else the environment has installed is none of these tests'."""
        allowed = os.environ["HALATION_PLUGINS"].replace("none", "")
        self.monkeypatch.setenv("HALATION_PLUGINS", f"{allowed},{package}")

    def install(self, package: str, version: str, names: tuple[str, ...] = ("Dim",), module: str = "") -> Path:
        """A package with these nodes; returns the folder of its code."""
        module = module or package.replace("-", "_")
        code = self.folder / module
        (code / "nodes" / "tone").mkdir(parents=True, exist_ok=True)
        for name in names:
            (code / "nodes" / "tone" / f"{name.lower()}.py").write_text(NODE.format(name=name))
        notes = self.folder / f"{package.replace('-', '_')}-{version}.dist-info"
        notes.mkdir()
        (notes / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: {version}\n")
        (notes / "entry_points.txt").write_text(f"[halation.nodes]\n{module} = {module}\n")
        self.allow(package)
        importlib.invalidate_caches()
        forget()
        return code


def forget() -> None:
    """Look for plug-ins anew."""
    for cached in (plugins, catalogue, load_library):
        cached.cache_clear()


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Site]:
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    loaded = set(sys.modules)
    yield Site(tmp_path, monkeypatch)
    for name in set(sys.modules) - loaded:
        if name.startswith(("acme", "other")):
            del sys.modules[name]
    forget()


def faults() -> dict[str, str]:
    return {plugin.package: plugin.fault for plugin in plugins()}


def test_its_nodes_have_its_name_in_front(site: Site) -> None:
    site.install("acme-tone", "2.1")
    node = catalogue()["acme_tone.dim"]
    assert (node.id, node.category, node.function) == ("acme_tone.dim", "tone", "acme_tone_dim")
    assert (node.shader, node.title) == ("acme_tone/tone/dim", "dim (acme tone)")
    assert node.required_package == "acme-tone==2.1"
    menus = [kind.category for kind in catalogue().values()]
    assert menus == sorted(menus) and len(catalogue()) == len(menus) == len([*catalogue()])


def test_built_in_ids_never_look_for_plugins(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    forget()
    monkeypatch.setattr("importlib.metadata.entry_points", lambda **_: pytest.fail("they are looked up"))
    assert catalogue()["exposure"].id == "exposure" and "no_such_node" not in catalogue()
    assert load_library().function("color/exposure", "exposure", "test").result == "vec4"


def test_a_fault_costs_only_that_plugin(site: Site) -> None:
    site.install("acme-tone", "1.0")
    code = site.install("other-tone", "3.0", ("Dim", "Fade"))
    (code / "nodes" / "tone" / "fade.py").write_text("import no_such_library\n")
    forget()
    assert faults() == {
        "acme-tone": "",
        "other-tone": "other_tone/nodes/tone/fade.py, line 1: ModuleNotFoundError: No module named 'no_such_library'",
    }
    assert "acme_tone.dim" in catalogue() and "other_tone.dim" not in catalogue()


FADE = NODE.format(name="Fade")
BROKEN = {
    "a syntax error": (
        "nodes/tone/fade.py",
        "\nx = (\n",
        "nodes/tone/fade.py, line 2: SyntaxError: '(' was never closed",
    ),
    "its own package": ("__init__.py", "a = 1\nimport no_such_library\n", "__init__.py, line 2: ModuleNotFoundError"),
    "a helper": (
        "nodes/tone/fade.py",
        "from ..._sums import total\n" + FADE,
        "_sums.py, line 3: ZeroDivisionError: division by zero",
    ),
    "a declaration": (
        "nodes/tone/fade.py",
        FADE.replace('factor: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5', "factor: complex = 0.5"),
        "nodes/tone/fade.py, line ",
    ),
    "a unit": ("nodes/tone/fade.py", FADE.replace("ratio", "pixels"), "nodes/tone/fade.py, line "),
    "another name": ("nodes/tone/fade.py", NODE.format(name="Gone"), "nodes/tone/fade.py: TypeError: the class Gone"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_the_file_and_the_line_at_fault_are_named(site: Site, case: str) -> None:
    name, text, sentence = BROKEN[case]
    code = site.install("acme-tone", "1.0", ("Dim", "Fade"))
    (code / "__init__.py").touch()
    (code / "_sums.py").write_text("\n\ntotal = 1 / 0\n")
    (code / name).write_text(text)
    importlib.invalidate_caches()
    forget()
    assert faults()["acme-tone"].startswith(f"acme_tone/{sentence}")


MISTAKES = {
    "a unit": ('"ratio"', '"pixels"', "value 'factor': there is no unit 'pixels'; did you mean 'px'? They are px, "),
    "aliases": ("    image", '    aliases = ("dark")\n    image', "write ('dark',)"),
    "upper case": ("    image", '    aliases = ("Dark",)\n    image', "write a tuple of names in lower case"),
    "a name": ("factor", "version", "'version' is a name that every node uses"),
    "no default": (" = 0.5", "", "value 'factor': it has no default"),
    "a default": ("= 0.5", '= "x"', "value 'factor': its default 'x' is no float"),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_declaration_that_means_something_else_is_refused(site: Site, case: str) -> None:
    old, new, sentence = MISTAKES[case]
    code = site.install("acme-tone", "1.0")
    (code / "nodes" / "tone" / "dim.py").write_text(NODE.format(name="Dim").replace(old, new))
    importlib.invalidate_caches()
    forget()
    assert sentence in faults()["acme-tone"], faults()


PASSES = """
from typing import Annotated
from halation.nodes import Draw, Drawn, Filter, Image, Slider

class Dim(Filter):
    \"\"\"Darken.\"\"\"

    image = Image()
    size: Annotated[float, Slider(0.0, 1.0, unit="ratio")] = 0.5

    def passes(self, draw: Draw) -> Drawn:
        return draw("acme_tone_dim", self.image, CALL)
"""


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        ("size=self.size", "TypeError: 'size' is an option of the draw itself, a width and a height"),
        ("edge=self.size", "TypeError: 'edge' is an option of the draw itself, an edge mode"),
        ("amount=self.siez", "AttributeError: 'Dim' object has no attribute 'siez'"),
    ],
)
def test_code_that_fails_while_it_draws_is_named_with_its_line(site: Site, call: str, sentence: str) -> None:
    code = site.install("acme-tone", "1.0")
    (code / "nodes" / "tone" / "dim.py").write_text(PASSES.replace("CALL", call))
    (code / "shaders" / "tone").mkdir(parents=True)
    (code / "shaders" / "tone" / "dim.glsl").write_text("vec4 acme_tone_dim(float amount) { return image_at(pixel); }")
    importlib.invalidate_caches()
    forget()
    with pytest.raises(GraphError) as fault:
        plan_node(catalogue()["acme_tone.dim"], (8, 8))
    place = "its plug-in acme-tone==1.0 fails at acme_tone/nodes/tone/dim.py, line 12: "
    assert f"{place}{sentence}" in str(fault.value)


def test_an_id_in_two_menus_is_refused(site: Site) -> None:
    code = site.install("acme-tone", "1.0")
    (code / "nodes" / "glow").mkdir()
    (code / "nodes" / "glow" / "dim.py").write_text(NODE.format(name="Dim"))
    forget()
    both = "acme_tone/nodes/glow/dim.py and acme_tone/nodes/tone/dim.py both make the node 'dim': rename one of them"
    assert faults() == {"acme-tone": both}


def test_an_entry_point_that_names_nothing_is_a_fault(site: Site) -> None:
    site.install("acme-tone", "1.0")
    (site.folder / "acme_tone-1.0.dist-info" / "entry_points.txt").write_text("[halation.nodes]\nx = acme_gone\n")
    forget()
    sentence = (
        "its entry point names the package 'acme_gone', which is not there: correct the entry point, or install "
        "acme-tone again"
    )
    assert faults() == {"acme-tone": sentence}
    unknown = Unknown("acme_tone.dim", {"type": "acme_tone.dim", "package": "Acme_Tone==1.0"})
    problem, *_ = problems(Graph(nodes={"dim": unknown}))
    assert problem.sentence.endswith(f"of the plug-in acme-tone 1.0, which cannot be loaded: {sentence}")


def test_two_plugins_with_one_id_are_both_refused_by_name(site: Site) -> None:
    site.install("acme-tone", "1.0")
    site.install("acme-copy", "0.5", module="acme_tone")
    site.install("other-tone", "3.0")
    sentence = (
        "acme-copy 0.5 and acme-tone 1.0 both bring a node 'acme_tone.dim': uninstall both, then install one of them"
    )
    assert faults() == {"acme-copy": sentence, "acme-tone": sentence, "other-tone": ""}
    assert "acme_tone.dim" not in catalogue() and "other_tone.dim" in catalogue()


def test_functions_of_shaders_have_its_name_in_front(site: Site) -> None:
    code = site.install("acme-tone", "1.0")
    (code / "shaders" / "tone").mkdir(parents=True)
    shader = code / "shaders" / "tone" / "dim.glsl"
    shader.write_text("vec4 acme_tone_dim(vec4 image, float factor) { return image * factor; }\n")
    forget()
    assert load_library().function("acme_tone/tone/dim", "acme_tone_dim", "test").name == "acme_tone_dim"
    shader.write_text("\nvec4 dim(vec4 image, float factor) { return image * factor; }\n")
    forget()
    with pytest.raises(ShaderError) as caught:
        load_library().function("acme_tone/tone/dim", "acme_tone_dim", "fade")
    assert caught.value.node == "fade"
    place = "node 'fade': acme_tone/shaders/tone/dim.glsl, line 2: "
    assert str(caught.value) == f"{place}the function 'dim' of a plug-in must begin with 'acme_tone_'"


def test_a_node_of_the_catalogue_is_named_by_its_type(site: Site) -> None:
    site.install("acme-tone", "1.0")
    with pytest.raises(ShaderError, match=r"^node 'acme_tone\.dim': acme_tone/shaders/tone/dim\.glsl: there is no"):
        plan_node(catalogue()["acme_tone.dim"], (64, 36))


def test_a_wheel_without_shaders_says_what_it_lacks(site: Site) -> None:
    site.install("acme-tone", "1.0")
    with pytest.raises(ShaderError) as caught:
        load_library().function("acme_tone/tone/dim", "acme_tone_dim", "node")
    assert str(caught.value) == (
        "node 'node': acme_tone/shaders/tone/dim.glsl: there is no such file; a package brings its shaders if "
        "[tool.setuptools.package-data] in its pyproject.toml names *.glsl"
    )
    with pytest.raises(ShaderError, match=r"shaders/tone/nowhere\.glsl: there is no such shader file$"):
        load_library().function("tone/nowhere", "nowhere", "node")


# --- graphs ----------------------------------------------------------------------------------------------------------


def graph_with_dim() -> Graph:
    graph = Graph().add("dim", catalogue()["acme_tone.dim"](factor=0.25)).add("blur", catalogue()["gaussian_blur"]())
    return graph.connect(Port("dim", "out"), Port("blur", "image")).mute("dim")


def test_a_graph_records_what_it_needs(site: Site) -> None:
    site.install("acme-tone", "2.1")
    text = document.dumps(graph_with_dim())
    assert '"package": "acme-tone==2.1"' in text
    assert text.count("package") == 1


def test_a_missing_plugin_is_a_placeholder_that_saves_unchanged(site: Site) -> None:
    site.install("acme-tone", "2.1")
    text = document.dumps(graph_with_dim())
    (site.folder / "acme_tone-2.1.dist-info" / "entry_points.txt").unlink()
    forget()
    graph = document.loads(text, sandbox=UNRESTRICTED)
    assert isinstance(graph.nodes["dim"], Unknown) and "dim" in graph.muted
    assert graph.links[Port("blur", "image")] == Port("dim", "out")
    assert document.dumps(graph) == text
    problem = next(item for item in problems(graph) if item.node == "dim")
    assert problem.rule.name == "missing-plugin"
    assert problem.sentence == (
        "node 'dim' has the type 'acme_tone.dim' of the plug-in acme-tone 2.1, which is not installed: "
        "pip install acme-tone==2.1"
    )


def test_a_plugin_with_a_fault_is_named_at_its_nodes(site: Site) -> None:
    code = site.install("acme-tone", "2.1")
    text = document.dumps(graph_with_dim())
    (code / "nodes" / "tone" / "fade.py").write_text("1 / 0\n")
    forget()
    sentence = next(
        item.sentence for item in problems(document.loads(text, sandbox=UNRESTRICTED)) if item.node == "dim"
    )
    assert "plug-in acme-tone 2.1, which cannot be loaded" in sentence and "division by zero" in sentence


def test_a_plugin_that_is_too_old_says_so(site: Site) -> None:
    site.install("acme-tone", "2.1")
    text = document.dumps(graph_with_dim()).replace("acme_tone.dim", "acme_tone.fade")
    sentence = next(
        item.sentence for item in problems(document.loads(text, sandbox=UNRESTRICTED)) if item.node == "dim"
    )
    assert "the installed acme-tone 2.1 does not have it: pip install acme-tone==2.1" in sentence


def test_nothing_but_a_package_is_repeated_as_a_command(site: Site) -> None:
    site.install("acme-tone", "2.1")
    text = document.dumps(graph_with_dim())
    for name in ("--index-url=http://example.org evil==1", "evil; rm -rf ~", "evil==1 && true", "git+https://x/y"):
        graph = document.loads(
            text.replace("acme_tone.dim", "gone.dim").replace("acme-tone==2.1", name), sandbox=UNRESTRICTED
        )
        sentence = next(item.sentence for item in problems(graph) if item.node == "dim")
        assert "pip" not in sentence and "unknown type" in sentence


def test_another_version_of_a_plugin_changes_no_file(site: Site) -> None:
    site.install("acme-tone", "2.1")
    text = document.dumps(graph_with_dim())
    (site.folder / "acme_tone-2.1.dist-info" / "METADATA").write_text(
        "Metadata-Version: 2.1\nName: acme-tone\nVersion: 2.2\n"
    )
    forget()
    graph = document.loads(text, sandbox=UNRESTRICTED)
    assert catalogue()["acme_tone.dim"].required_package == "acme-tone==2.2"
    assert document.dumps(graph) == text
    assert not [item for item in problems(graph) if item.rule.name == "unknown-key"]


def test_only_the_packages_that_the_user_allows_are_loaded(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    site.install("acme-tone", "2.1")
    site.install("other-tone", "1.0")
    for allowed, packages in (
        ("none", []),
        ("acme-tone", ["acme-tone"]),
        (" Acme_Tone , other.tone", ["acme-tone", "other-tone"]),
    ):
        monkeypatch.setenv("HALATION_PLUGINS", allowed)
        forget()
        assert [plugin.package for plugin in plugins()] == packages
        assert {id.partition(".")[0] for id in catalogue() if "." in id} == {
            package.replace("-", "_") for package in packages
        }
    monkeypatch.delenv("HALATION_PLUGINS")
    forget()
    assert {"acme-tone", "other-tone"} <= {plugin.package for plugin in plugins()}
