"""`halation render --burn-in`, and the tokens that texts have of files."""

from __future__ import annotations

import json

import numpy as np
import OpenImageIO as oiio


def pixels(path) -> np.ndarray:
    return oiio.ImageBuf(str(path)).get_pixels()


def test_burn_in_is_the_preset_over_each_picture(cli, graphs, tmp_path):
    """The middle of the picture stays; the corners are those of a graph that has the group itself."""
    graph = graphs()
    for name, words in (("plain", ()), ("burnt", ("--burn-in",))):
        done = cli("render", graph, "-o", tmp_path / f"{name}.exr", "--frame", "7", "--size", "320x180", *words)
        assert done.code == 0, done.err
    plain, burnt = pixels(tmp_path / "plain.exr"), pixels(tmp_path / "burnt.exr")
    np.testing.assert_array_equal(burnt[60:120, 60:260], plain[60:120, 60:260])
    for rows in (slice(0, 20), slice(160, 180)):
        for columns in (slice(0, 60), slice(260, 320)):
            assert np.abs(burnt[rows, columns] - plain[rows, columns]).max() > 0.2


def test_burn_in_needs_a_picture(cli, graphs, tmp_path):
    done = cli("render", graphs(), "-o", tmp_path / "a.exr", "--burn-in", "--node", "light")
    assert (done.code, "leave out --node" in done.err) == (2, True)
    field = tmp_path / "mask.json"
    tree = {"halation": 1, "nodes": {"shape": {"type": "shape"}}, "links": {"outputs.mask": "shape.mask"}}
    field.write_text(json.dumps(tree | {"outputs": {"mask": {"type": "Field"}}}))
    done = cli("render", field, "-o", tmp_path / "a.exr", "--burn-in")
    assert done.code == 2 and "no output of the graph is a picture" in done.err, done.err


def test_texts_know_their_picture_and_frame(cli, tmp_path):
    """`{file}` and `{meta:...}` are those of the file that the input comes from, through other nodes and a sequence."""
    spec = oiio.ImageSpec(96, 32, 4, "half")
    spec.attribute("Make", "Lens & Co")
    oiio.ImageBuf(spec).write(str(tmp_path / "plate.0007.exr"))
    tree = {
        "halation": 1,
        "nodes": {
            "read": {"type": "read_image", "values": {"path": "plate.####.exr"}},
            "soft": {"type": "gaussian_blur", "values": {"sigma": 2.0}},
            "title": {"type": "text", "values": {"text": "{file} {meta:make} {frame:4}", "size": 0.2}},
            "plain": {"type": "text", "values": {"text": "plate.0007.exr Lens & Co 0007", "size": 0.2}},
        },
        "links": {"soft.image": "read.out", "title.image": "soft.out", "plain.image": "soft.out"},
    }  # fmt: skip
    (tmp_path / "g.json").write_text(json.dumps(tree))
    drawn = []
    for name in ("title", "plain"):
        target = tmp_path / f"{name}.exr"
        done = cli("render", tmp_path / "g.json", "--node", name, "-o", target, "--frame", "7")
        assert done.code == 0, done.err
        drawn.append(pixels(target))
    np.testing.assert_array_equal(*drawn)
    assert drawn[0][..., 0].sum() > 10.0


def test_a_font_outside_of_the_root_is_refused(cli, tmp_path):
    inside, outside = tmp_path / "in", tmp_path / "out"
    inside.mkdir(), outside.mkdir()
    (outside / "font.ttf").write_bytes(b"font")
    nodes = {"title": {"type": "text", "values": {"font": "../out/font.ttf"}}}
    (inside / "g.json").write_text(json.dumps({"halation": 1, "nodes": nodes}))
    words = ("render", inside / "g.json", "--node", "title", "-o", inside / "a.exr", "--root", inside)
    done = cli(*words)
    assert done.code != 0 and "font.ttf" in done.err and "root" in done.err, done.err
