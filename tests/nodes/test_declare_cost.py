"""What declarations cost when they are loaded: texts of annotations are compiled once, or not at all."""

from __future__ import annotations

import json
import subprocess
import sys

WATCH = (
    "import json, sys\n"
    "texts = []\n"
    "def watch(event, arguments):\n"
    "    if event == 'compile' and sys._getframe(1).f_globals['__name__'] == 'typing':\n"
    "        texts.append(str(arguments[0]))\n"
    "sys.addaudithook(watch)\n"
)


def list_compiled_annotations(code: str) -> list[str]:
    """The texts of annotations that Python compiles while it runs the code, which begins with nothing loaded."""
    command = [sys.executable, "-c", f"{WATCH}{code}\nprint(json.dumps([str(text) for text in texts]))"]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def test_the_watch_sees_annotations():
    code = "import typing\nclass A:\n    x: 'int | None' = 0\ntyping.get_type_hints(A)"
    assert len(list_compiled_annotations(code)) == 1


def test_lights_shapes_and_options_are_declared_without_texts():
    lights = list_compiled_annotations("import halation.nodes")
    assert not [text for text in lights if "Slider" in text or "ClassVar" in text], lights
    options = list_compiled_annotations("from halation.cli.program import Commands; Commands()['render']")
    assert not [text for text in options if "Annotated" in text or "GraphFile" in text or "Sandbox" in text], options


def test_a_node_compiles_the_annotations_of_its_values_alone():
    """Not those of `Node`, which declares 16 class variables. The values of a mask are objects."""
    code = (
        "from typing import Annotated, ClassVar\n"
        "from halation.nodes import Image, Pointwise, Slider\n"
        "before = len(texts)\n"
        "class Some(Pointwise):\n"
        "    kept: 'ClassVar[int]' = 3\n"
        "    image = Image()\n"
        "    first: 'Annotated[float, Slider(0.0, 2.0, unit=\"EV\")]' = 0.5\n"
        "assert list(Some.values) == ['first', 'mix', 'invert_mask'] and Some.kept == 3\n"
        "class More(Some):\n"
        "    second: 'Annotated[float, Slider(0.0, 1.0, unit=\"EV\")]' = 0.0\n"
        "assert More.values['first'] == Some.values['first'] and More.values['second'].default == 0.0\n"
        "texts = texts[before:]"
    )
    assert len(list_compiled_annotations(code)) == 3
