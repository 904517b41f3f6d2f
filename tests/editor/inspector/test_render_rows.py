"""What the inspector shows of a render that a node reads."""

from __future__ import annotations

from pathlib import Path

import OpenImageIO as oiio
from halation.graph import Graph, Port
from halation.nodes import catalogue
from still_editor import open_still_editor

RENDER = Path(__file__).parents[2] / "data/blender50_frame_before.exr"
"""A part for each pass, all of one view layer."""


def list_part_names() -> list[str]:
    """The names of the parts of the file."""
    file, names = oiio.ImageInput.open(str(RENDER)), list[str]()
    assert file is not None
    while file.seek_subimage(len(names), 0):
        names.append(file.spec().getattribute("oiio:subimagename"))
    return names


def test_parts_are_listed_by_their_names_without_what_all_have_in_common(tmp_path: Path) -> None:
    names = list_part_names()
    assert len(names) > 1 and {name.partition(".")[0] for name in names} == {"ViewLayer"}
    graph = Graph().add("read", catalogue()["read_render"]()).set(Port("read", "path"), str(RENDER))
    with open_still_editor(tmp_path, graph, screen=(3000.0, 3000.0)) as still:
        still.select("read")
        still.show("Inspector", 4)
        still.click("Inspector", "more read parts")
        shown = still.pane.list_texts()
    assert {name.removeprefix("ViewLayer.") for name in names} <= {*shown}
