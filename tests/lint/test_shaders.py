"""`halation check` reads the shaders of a graph as far as a render does without a device."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from halation.errors import HalationError
from halation.lint.checking import GraphChecker
from halation.renderer import open_device
from halation.renderer.engine import Renderer
from halation.resources.sandbox import UNRESTRICTED

FUNCTION = "vec4 tint(vec4 image) { return image; }"


def write_graph(folder: Path, *code: str) -> Path:
    """A graph of one code node, in the layout of `halation fmt`."""
    file = folder / "graph.json"
    document = {
        "halation": 1,
        "inputs": {"beauty": {"default": 0.5, "type": "Image"}},
        "links": {"outputs.image": "tint.out", "tint.image": "inputs.beauty"},
        "nodes": {"tint": {"code": list(code), "type": "glsl"}},
        "outputs": {"image": {"type": "Image"}},
    }
    file.write_text(json.dumps(document, indent=2) + "\n")
    return file


@pytest.mark.parametrize(
    ("include", "sentence"),
    [
        ("lib/colour.glsl", "#include \"lib/colour.glsl\" names no shader file; did you mean 'lib/color.glsl'?"),
        ("Lib/color.glsl", "#include \"Lib/color.glsl\" names no shader file; did you mean 'lib/color.glsl'?"),
        ("nowhere.glsl", '#include "nowhere.glsl" names no shader file'),
    ],
)
def test_an_include_of_no_file_is_found_where_it_stands(tmp_path: Path, include: str, sentence: str) -> None:
    file = write_graph(tmp_path, f'#include "{include}"', FUNCTION)
    (finding,) = [item for item in GraphChecker(UNRESTRICTED).check_file(file).findings if item.code]
    assert (finding.problem.rule.name, finding.problem.node, finding.code) == ("broken-shader", "tint", 5)
    assert finding.problem.sentence == f"node 'tint': the code of 'tint', line 1: {sentence}"
    assert finding.line == file.read_text().split("\n").index('    "tint": {') + 1


def test_check_and_render_say_the_same(tmp_path: Path) -> None:
    from halation import document

    file = write_graph(tmp_path, '#include "lib/alhpa.glsl"', FUNCTION)
    (finding,) = [item for item in GraphChecker(UNRESTRICTED).check_file(file).findings if item.code]
    renderer = Renderer(open_device(sandbox=UNRESTRICTED), sandbox=UNRESTRICTED)
    with pytest.raises(HalationError) as caught:
        renderer.render(document.load(file, sandbox=UNRESTRICTED))
    renderer.close()
    assert (str(caught.value), caught.value.exit_code) == (finding.problem.sentence, finding.code)


def test_an_include_of_a_file_is_fine(tmp_path: Path) -> None:
    file = write_graph(tmp_path, '#include "lib/color.glsl"', FUNCTION)
    assert not [item for item in GraphChecker(UNRESTRICTED).check_file(file).findings if item.code]
