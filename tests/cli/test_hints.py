"""Messages say what to do about mistakes that newcomers make."""

from __future__ import annotations

import pytest


def test_a_picture_in_place_of_a_graph(fails, shot):
    sentence = "this is a picture, not a graph: name a graph, and the picture after -i as NAME=shot.exr"
    assert fails(3, "render", shot) == f"{shot}: {sentence}"


@pytest.mark.parametrize(
    ("words", "hint"),
    [("stops=1", "; write light.stops"), ("gain=1", ""), ("light.stops=x", "")],
)
def test_a_value_without_its_node(fails, graphs, words, hint):
    sentence = fails(2, "render", graphs(), "--set", words)
    assert sentence.endswith(hint) and ("; write" in sentence) == bool(hint)


def test_several_nodes_have_the_value(fails, graphs):
    sentence = fails(2, "render", graphs(nodes={"more": {"type": "exposure"}}), "--set", "stops=1")
    assert sentence.endswith("; write light.stops or more.stops")


def test_the_cause_is_named_first(fails, graphs):
    """A misspelt target leaves its input without a picture; the sentence is about the target."""
    path = graphs(links={"light.image": "inputs.nothing"})
    assert "'inputs.nothing'" in fails(3, "render", path).replace("input 'nothing'", "'inputs.nothing'")
    path = graphs(
        nodes={"blur": {"type": "gaussian_blur"}}, links={"blur.img": "light.out", "outputs.image": "blur.out"}
    )
    sentence = fails(3, "render", path)
    assert "img" in sentence and "1 more" in sentence


def test_a_link_the_wrong_way_round(fails, graphs):
    path = graphs(nodes={"blur": {"type": "gaussian_blur"}}, links={"light.out": "blur.image"})
    sentence = fails(3, "render", path)
    assert '; a link names its target first: write "blur.image": "light.out"' in sentence


@pytest.mark.parametrize(("layer", "is_told"), [("Depth", True), ("Cool", False)])
def test_data_in_place_of_color(cli, graphs, shot, tmp_path, layer, is_told):
    path = graphs(nodes={"light": {"type": "exposure"}})
    result = cli("render", path, "-i", f"beauty={shot}:{layer}", "-o", tmp_path / "out.exr")
    assert result.code == 0
    assert (f"'light' works on color, but the layer {layer} is data" in result.err) == is_told


def test_misspelt_keys_are_told_beside_what_follows_from_them(cli, tmp_path):
    path = tmp_path / "graph.json"
    path.write_text(
        '{"halation": 1, "outputs": {"image": {"type": "Image"}}, "link": {"outputs.image": "n.out"},'
        ' "nodes": {"n": {"type": "noise", "version": 1, "value": {"octaves": 2}}}}'
    )
    result = cli("render", path, "-o", tmp_path / "out.png")
    assert result.code == 3
    assert "link means nothing to this version and is only kept; did you mean 'links'?" in result.err
    assert "nodes.n.value means nothing to this version and is only kept; did you mean 'values'?" in result.err


def test_a_file_that_is_not_there_has_no_line(cli, tmp_path):
    path = tmp_path / "nothere"
    assert cli("check", path).out == f"{path}: error: there is no such file [unreadable-graph]\n"


def test_counts_have_their_nouns(cli, graphs, tmp_path):
    graphs("good.json")
    (tmp_path / "bad.json").write_text('{"halation": 1, "nodes": {"a": {"type": "nonsense"}}}')
    assert "2 graphs: 1 error, " in cli("check", tmp_path).err
    assert ", 1 pass, " in cli("render", tmp_path / "good.json", "-o", tmp_path / "out.exr").err
