"""What of a header cannot be used is reported by `info` and by rendering."""

from __future__ import annotations

import json

import numpy as np
import OpenImageIO as oiio
from oiio_pictures import write_picture


def test_impossible_chromaticities(cli, tmp_path):
    numbers = (oiio.TypeDesc("float[8]"), (0.0,) * 8)
    path = write_picture(tmp_path / "a.exr", np.ones((4, 4, 3), np.float32), attributes={"chromaticities": numbers})
    graph = {"halation": 1, "nodes": {"n": {"type": "read_image", "values": {"path": "a.exr"}}}}
    graph |= {"outputs": {"image": {"type": "Image"}}, "links": {"outputs.image": "n.out"}}
    (tmp_path / "g.json").write_text(json.dumps(graph))
    ended = cli("render", tmp_path / "g.json", "-o", tmp_path / "b.exr", "--json")
    assert (
        ended.code == 0 and f"{path}: its chromaticities (0, 0, 0, 0, 0, 0, 0, 0) are those of no colors" in ended.err
    )
    assert json.loads(ended.out)["warnings"][str(path)].startswith("its chromaticities")
    assert "those of no colors: give the input a color_space" in cli("info", path).out
