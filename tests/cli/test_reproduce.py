"""`halation reproduce`: pictures come again from their own headers, and what is not as it was is named."""

from __future__ import annotations

import json
import os
import shutil

import numpy as np
import OpenImageIO as oiio
import pytest
from exr_files import header, read, write_exr
from halation.presets import paths as presets
from halation.renderer.jobs.picture_settings import RecordedSettings
from halation.renderer.provenance.recipe import read_recipe
from halation.renderer.provenance.reproduction import compare_layers
from halation.resources.sandbox import UNRESTRICTED
from msgspec import structs

PRESETS = {path.stem: path for path in presets()}
TRAIL = {
    "nodes": {"trail": {"type": "frame_blend"}},
    "links": {"trail.image": "light.out", "outputs.image": "trail.out"},
}
BODY = {
    "halation": 1,
    "inputs": {"image": {"type": "Image"}, "more": {"type": "Image", "file": "dust.exr"}},
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"mix": {"type": "merge", "values": {"mode": "plus"}}},
    "links": {"mix.a": "inputs.image", "mix.b": "inputs.more", "outputs.image": "mix.out"},
}


def render(cli, graph, out, *words):
    result = cli("render", graph, "-o", out, *words)
    assert result.code == 0, result.err
    return out


def again(cli, picture, *words, code=0):
    result = cli("reproduce", picture, *words, "--json")
    assert result.code == code, (result.err, result.out)
    return result.json


@pytest.fixture
def movie(tmp_path, graphs):
    """A graph of a sequence of eight frames in a folder of its own, and of what a node remembers of them."""
    folder = tmp_path / "in"
    folder.mkdir()
    for frame in range(1, 9):
        picture = np.full((8, 12, 4), frame / 4.0, np.float32)
        write_exr(folder / f"take.{frame:04d}.exr", {"Combined": picture}, {"Combined": "float"})

    def made(**parts):
        return graphs(inputs={"beauty": {"type": "Image", "file": "in/take.####.exr"}}, **parts)

    return made


@pytest.mark.parametrize(
    ("preset", "words", "ending"),
    [
        ("soft_bloom", ("--scale", "0.5"), "exr"),
        ("soft_bloom", ("--set", "bloom.intensity=0.7"), "png"),
        ("night_street", ("--size", "120x68"), "tif"),
        ("x_ray", ("--scale", "0.25", "--precision", "float"), "png"),
        ("rack_focus", ("--frame", "7", "--scale", "0.25"), "exr"),
        ("feedback_tunnel", ("--frame", "5", "--scale", "0.25"), "exr"),
        ("long_exposure", ("--frame", "5", "--scale", "0.25"), "png"),
        ("comic_ink", ("--node", "ink", "--scale", "0.25"), "exr"),
        ("moonlight", ("--scale", "0.25"), "jpg"),
    ],
)
def test_presets_come_again_bit_for_bit(cli, tmp_path, preset, words, ending):
    """Plain, animated, with a history; proxies, values, single nodes; every format that holds a graph."""
    if "--node" in words:
        names = json.loads(PRESETS[preset].read_text())["nodes"]
        words = tuple(next(iter(names)) if word == "ink" else word for word in words)
    picture = render(cli, PRESETS[preset], tmp_path / f"out.{ending}", *words)
    found = again(cli, picture)
    assert found["same"] and found["tolerance"] == 0.0 and not found["differences"]
    assert {item["state"] for item in found["inputs"]} <= {"same"}
    assert all(layer["equal"] and layer["farthest"] == 0.0 for layer in found["pixels"]) and found["pixels"]


def test_what_is_kept_is_the_same_file(cli, graphs, tmp_path):
    parts = {
        "inputs": {"depth": {"type": "Field", "file": "shot.exr", "layer": "Depth"}},
        "outputs": {"image": {"type": "Image"}, "far": {"type": "Field"}},
        "links": {"outputs.far": "inputs.depth"},
    }
    words = ("--compression", "piz", "--set", "light.stops=0.37")
    picture = render(cli, graphs(**parts), tmp_path / "out.exr", *words)
    found = again(cli, picture, "-o", tmp_path / "again.exr", "-o", tmp_path / "far.exr")
    assert [layer["layer"] for layer in found["pixels"]] == ["image", "far"]
    assert (tmp_path / "again.exr").read_bytes() == picture.read_bytes() and (tmp_path / "far.exr").exists()
    assert cli("reproduce", picture, "-o", picture).code == 2


def test_headers_say_nothing_of_when_and_where(cli, graphs, shot, tmp_path):
    """The same graph and files in another folder, written at another time, give the same bytes."""
    other = tmp_path / "elsewhere"
    other.mkdir()
    for ending in ("exr", "png", "jpg", "tif"):
        first = render(cli, graphs(), tmp_path / f"out.{ending}")
        for path in (graphs(), shot):
            shutil.copyfile(path, other / path.name)
        os.utime(other / shot.name, (1e9, 1e9))
        second = render(cli, other / "graph.json", other / f"result.{ending}")
        assert first.read_bytes() == second.read_bytes(), ending
    assert str(tmp_path) not in "".join(str(item) for item in header(tmp_path / "out.exr").extra_attribs)


def test_one_pixel_of_an_input_is_noticed(cli, graphs, shot, tmp_path):
    picture = render(cli, graphs(), tmp_path / "out.exr")
    layers = {name: read(shot, part) for part, name in enumerate(("Combined", "Cool", "Depth"))}
    layers["Combined"][5, 7, 1] = 0.75
    write_exr(shot, layers, {"Combined": "half", "Cool": "half", "Depth": "float"})
    result = cli("reproduce", picture)
    assert result.code == 1 and "beauty: shot.exr: changed, was " in result.out
    found = again(cli, picture, code=1)
    (layer,) = found["pixels"]
    assert found["inputs"][0]["state"] == "changed" and found["inputs"][0]["then"] != found["inputs"][0]["now"]
    assert layer["max_abs"] == 1.0 and layer["failing"] == pytest.approx(1 / (48 * 32)), "0.25 and 0.75, doubled"
    assert again(cli, picture, "--tolerance", "1")["same"]


def test_the_farthest_number_is_relative_above_one():
    """|a - b|, divided by what was expected where that is above 1; by the largest code of integers; NaN is NaN."""
    cases = {
        "small": (np.float32([[[0.25, 0.5]]]), np.float32([[[0.25, 0.75]]]), 0.25),
        "large": (np.float32([[[404.0, 8.0]]]), np.float32([[[400.0, 8.5]]]), 0.5 / 8.5),
        "negative": (np.float32([[[-6.0]]]), np.float32([[[-4.0]]]), 0.5),
        "codes": (np.uint8([[[10, 255]]]), np.uint8([[[10, 204]]]), 0.2),
        "deep": (np.uint16([[[0]]]), np.uint16([[[65535]]]), 1.0),
        "nan": (np.float32([[[np.nan, np.inf]]]), np.float32([[[np.nan, np.inf]]]), 0.0),
        "one nan": (np.float32([[[np.nan]]]), np.float32([[[2.0]]]), np.inf),
        "size": (np.zeros((2, 3, 1), np.float32), np.zeros((3, 2, 1), np.float32), np.inf),
        "type": (np.zeros((2, 3, 1), np.float32), np.zeros((2, 3, 1), np.uint8), np.inf),
    }
    actual, expected = ({name: case[at] for name, case in cases.items()} for at in (0, 1))
    layers = compare_layers(actual | {"more": actual["small"]}, expected | {"less": expected["small"]})
    found = {layer.name: layer.farthest for layer in layers}
    assert found == pytest.approx({name: case[2] for name, case in cases.items()} | {"more": np.inf, "less": np.inf})


def test_another_layer_of_the_input_makes_the_same_picture(cli, graphs, shot, tmp_path):
    """The file is another one, what was read of it is not: said, and no difference."""
    picture = render(cli, graphs(), tmp_path / "out.exr")
    layers = {name: read(shot, part) for part, name in enumerate(("Combined", "Cool", "Depth"))}
    layers["Depth"][0, 0, 0] = 77.0
    write_exr(shot, layers, {"Combined": "half", "Cool": "half", "Depth": "float"})
    found = again(cli, picture)
    assert found["same"] and found["inputs"][0]["state"] == "changed"


def test_an_input_that_has_moved(cli, graphs, shot, tmp_path, monkeypatch):
    """Named, found by name below a folder, found by content under another name; else a sentence with its name."""
    picture = render(cli, graphs(), tmp_path / "out.exr", "-i", f"{shot}:Cool")
    monkeypatch.chdir(tmp_path)
    store = tmp_path / "store" / "deep"
    store.mkdir(parents=True)
    moved = shot.rename(store / "shot.exr")
    lost = cli("reproduce", picture)
    assert lost.code == 4 and "files that it was made from are missing: shot.exr (beauty)" in lost.err
    assert "-i beauty=FILE" in lost.err and "--search DIR" in lost.err
    assert again(cli, picture, "-i", f"beauty={moved}")["same"]
    assert again(cli, picture, "--search", tmp_path / "store")["same"]
    renamed = moved.rename(store / "other name é.exr")
    found = again(cli, picture, "--search", tmp_path / "store")
    assert found["same"] and found["inputs"][0]["path"] == str(renamed)
    assert cli("reproduce", picture, "-i", "beauty=nowhere.exr").code == 4
    wrong = cli("reproduce", picture, "-i", "beuty=x.exr")
    assert wrong.code == 2 and "did you mean 'beauty'?" in wrong.err


def test_a_sequence_with_a_history(cli, movie, tmp_path):
    """All frames that lead up to a picture count, wherever they lie; what a sequence has besides does not."""
    picture = render(cli, movie(**TRAIL), tmp_path / "out.exr", "--frame", "5")
    found = again(cli, picture)
    assert found["same"] and found["inputs"][0]["file"] == "take.####.exr"
    moved = (tmp_path / "in").rename(tmp_path / "takes")
    shutil.copyfile(moved / "take.0001.exr", moved / "take.0000.exr")
    assert again(cli, picture, "--search", moved)["same"]
    assert again(cli, picture, "-i", f"beauty={moved}/take.####.exr")["same"]
    write_exr(moved / "take.0002.exr", {"Combined": np.ones((8, 12, 4), np.float32)}, {"Combined": "float"})
    found = again(cli, picture, "--search", moved, code=1)
    assert found["inputs"][0]["state"] == "changed" and not found["same"]
    (moved / "take.0002.exr").unlink()
    assert cli("reproduce", picture, "--search", moved).code == 4


def test_a_frame_of_a_sequence_needs_that_file_only(cli, movie, tmp_path):
    picture = render(cli, movie(), tmp_path / "out.0005.exr", "--frame", "5")
    for frame in (1, 2, 3, 4, 6, 7, 8):
        (tmp_path / "in" / f"take.{frame:04d}.exr").unlink()
    assert again(cli, picture)["same"]


def test_frames_around_the_one_that_is_made(cli, movie, tmp_path):
    """A node that looks at other frames reads several files of one sequence."""
    late = {
        "late": {"type": "time_offset", "values": {"frames": 2}},
        "mix": {"type": "merge", "values": {"mode": "plus"}},
    }
    links = {"late.image": "light.out", "mix.a": "late.out", "mix.b": "light.out", "outputs.image": "mix.out"}
    graph = movie(nodes=late, links=links)
    picture = render(cli, graph, tmp_path / "out.exr", "--frame", "3", "--precision", "float")
    found = again(cli, picture)
    assert found["same"] and found["inputs"][0]["file"] == "take.####.exr"
    write_exr(tmp_path / "in" / "take.0007.exr", {"Combined": np.ones((8, 12, 4), np.float32)}, {"Combined": "float"})
    assert again(cli, picture)["inputs"][0]["state"] == "same"


def test_groups_and_what_they_read_are_inside(cli, graphs, tmp_path):
    """Paths in a group start at the folder of its file; without that file they are found all the same."""
    library = tmp_path / "library"
    library.mkdir()
    write_exr(library / "dust.exr", {"Combined": np.full((32, 48, 4), 0.5, np.float32)}, {"Combined": "half"})
    (library / "dusty.json").write_text(json.dumps(BODY))
    graph = graphs(
        nodes={"dusty": {"type": "group", "path": "library/dusty.json"}},
        links={"dusty.image": "light.out", "outputs.image": "dusty.image"},
    )
    picture = render(cli, graph, tmp_path / "out.png")
    (library / "dusty.json").unlink()
    graph.unlink()
    found = again(cli, picture)
    assert found["same"] and {item["name"] for item in found["inputs"]} == {"beauty", "dusty/inputs.more"}


def test_the_graph_that_made_it(cli, graphs, shot, tmp_path):
    picture = render(cli, graphs(), tmp_path / "out.png", "--set", "light.stops=-1.25", "-i", f"{shot}:Cool")
    folder = tmp_path / "saved"
    folder.mkdir()
    result = cli("reproduce", picture, "--graph", folder / "made.json")
    assert result.code == 0 and result.out == ""
    tree = json.loads((folder / "made.json").read_text())
    assert tree["nodes"]["light"]["values"] == {"stops": -1.25}
    assert tree["inputs"]["beauty"] == {"type": "Image", "file": "../shot.exr", "layer": "Cool"}
    assert cli("fmt", "--check", folder / "made.json").code == 0
    same = render(cli, folder / "made.json", tmp_path / "same.png")
    np.testing.assert_array_equal(read(same), read(picture))
    assert json.loads(cli("reproduce", picture, "--graph", "-").out)["nodes"] == tree["nodes"]
    shot.unlink()
    assert cli("reproduce", picture, "--graph", folder / "made.json").code == 0, "no input is needed for the graph"


def test_nothing_beyond_the_fence_is_read_or_written(cli, graphs, shot, tmp_path):
    inside = tmp_path / "inside"
    inside.mkdir()
    picture = render(cli, graphs(), inside / "out.exr", "-i", shot)
    lost = cli("reproduce", picture, "--root", inside, "--search", tmp_path)
    assert lost.code == 4 and "files that it was made from are missing: shot.exr (beauty)" in lost.err
    shutil.copy(shot, inside)
    assert again(cli, picture, "--root", inside)["same"]
    assert sorted(path.name for path in inside.iterdir()) == ["out.exr", "shot.exr"]
    refused = cli("reproduce", picture, "--root", inside, "-o", tmp_path / "again.exr")
    assert refused.code == 1 and "lies outside of" in refused.err and not (tmp_path / "again.exr").exists()


def test_files_that_hold_no_graph(cli, graphs, shot, tmp_path):
    webp = render(cli, graphs(), tmp_path / "out.webp")
    plain = tmp_path / "plain.png"
    assert oiio.ImageBuf(np.zeros((4, 4, 3), np.float32)).write(str(plain))
    empty, text = tmp_path / "empty.png", tmp_path / "text.png"
    empty.touch()
    text.write_text("hello")
    for path in (webp, plain, shot):
        result = cli("reproduce", path)
        assert result.code == 4 and "its header holds no graph" in result.err and result.err.count("\n") == 1
    for path in (empty, text, tmp_path / "missing.exr", tmp_path):
        result = cli("reproduce", path)
        assert result.code == 4 and result.err.startswith(f"halation: {path}: ") and result.err.count("\n") == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("halation:graph", "{"),
        ("halation:graph", '{"halation": 99}'),
        ("halation:job", "{"),
        ("halation:job", "[1]"),
        ("halation:job", '{"frame": "soon"}'),
        ("halation:job", '{"size": [3]}'),
        ("halation:settings", "frame=soon"),
        ("halation:settings", "size=3x"),
        ("halation:settings", "view='"),
        ("halation:input:inputs.beauty", "shot.exr"),
    ],
)
def test_damaged_headers_are_a_sentence(cli, graphs, tmp_path, name, text):
    picture, broken = render(cli, graphs(), tmp_path / "out.exr"), tmp_path / "broken.exr"
    buffer = oiio.ImageBuf(str(picture))
    if name == "halation:settings":
        buffer.specmod().erase_attribute("halation:job")
    buffer.specmod().attribute(name, text)
    assert buffer.write(str(broken))
    result = cli("reproduce", broken)
    assert result.code in (3, 4) and result.err.startswith(f"halation: {broken}") and result.err.count("\n") == 1


def test_a_header_holds_the_settings_of_the_job_and_no_paths(cli, graphs, tmp_path):
    picture = render(cli, graphs(), tmp_path / "out.exr", "--scale", "0.5", "--frame", "7", "--precision", "float")
    text = header(picture).get_string_attribute("halation:job")
    settings = RecordedSettings.from_json(text)
    assert (settings.scale, settings.frame, settings.precision) == (0.5, 7, "float")
    assert settings.to_json() == text and len(text) < 300 and str(tmp_path) not in text
    assert RecordedSettings.from_json('{"frame": 3, "of_a_later_version": 1}').frame == 3


def test_the_words_of_an_older_header_mean_the_same(cli, graphs, tmp_path):
    picture, older = render(cli, graphs(), tmp_path / "out.exr", "--scale", "0.5"), tmp_path / "older.exr"
    buffer = oiio.ImageBuf(str(picture))
    buffer.specmod().erase_attribute("halation:job")
    words = "scale=0.5 frame=1 output=image precision=half intermediates=half form=compute compression=zip"
    buffer.specmod().attribute("halation:settings", words)
    assert buffer.write(str(older))
    new, old = (read_recipe(path, sandbox=UNRESTRICTED).settings for path in (picture, older))
    assert structs.replace(new, form=old.form, intermediates=old.intermediates) == old
    assert again(cli, older)["same"]


def test_an_older_header_says_less(cli, graphs, tmp_path):
    picture, older = render(cli, graphs(), tmp_path / "out.exr"), tmp_path / "older.exr"
    buffer = oiio.ImageBuf(str(picture))
    for name in ("halation:driver", "halation:key", "halation:job"):
        buffer.specmod().erase_attribute(name)
    buffer.specmod().attribute("halation:settings", "scale=1.0 frame=1")
    buffer.specmod().attribute("halation:renderer", "another one")
    assert buffer.write(str(older))
    found = again(cli, older)
    assert found["same"] and [item["what"] for item in found["differences"]] == ["renderer"]
    assert found["tolerance"] == pytest.approx(1 / 255)
