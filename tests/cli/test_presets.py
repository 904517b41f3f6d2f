"""Presets are named without folder and ending, wherever a command takes a graph; `halation demo` copies them."""

from __future__ import annotations

import json
import shutil

import halation as hal
import pytest
from halation import presets
from halation.custom_nodes.plugins import find_graph_or_preset
from halation.errors import DocumentError
from halation.nodes import catalogue, plugins

BLOOM = presets.sample().parents[1] / "soft_bloom.json"
NOISE = {
    "halation": 1,
    "outputs": {"image": {"type": "Image"}},
    "nodes": {"noise": {"type": "noise", "version": 1}},
    "links": {"outputs.image": "noise.out"},
}


@pytest.fixture
def empty(tmp_path_factory, monkeypatch):
    """An empty folder, which is the current one."""
    folder = tmp_path_factory.mktemp("empty")
    monkeypatch.chdir(folder)
    return folder


def test_every_command_that_takes_a_graph_takes_a_preset(cli, empty, shot):
    assert cli("render", "soft_bloom", "-i", f"beauty={shot}", "-o", "out.png").code == 0
    for words in (
        ("check", "soft_bloom"),
        ("check", "soft_bloom", "night_street"),
        ("explain", "soft_bloom"),
        ("sweep", "soft_bloom", "-i", shot, "--set", "bloom.intensity=0.1,0.9", "-o", "sheet.png", "--cell", "32"),
        ("bench", "soft_bloom", "-i", shot, "-n", 1),
        ("diff", "soft_bloom", BLOOM),
    ):
        result = cli(*words)
        assert result.code == 0, result
    assert cli("diff", "soft_bloom", "night_street").code == 1
    assert {path.name for path in empty.iterdir()} == {"out.png", "sheet.png"}
    assert hal.load("soft_bloom") == hal.load(BLOOM)


def test_processes_find_it_too(cli, empty, shot):
    assert cli("render", "moving_ball", "-o", "out.####.png", "--frames", "1-2", "-j", 2, "--size", "32x18").code == 0
    assert len(list(empty.glob("out.*.png"))) == 2


def test_the_editor_opens_it(cli, empty, monkeypatch):
    from halation import editor

    opened = []
    monkeypatch.setattr(editor, "edit", lambda path, *rest: opened.append(path))
    assert cli("edit", "soft_bloom").code == 0
    assert opened == [BLOOM]


def test_the_editor_begins_a_lesson_by_its_name_or_the_next_one(cli, empty, monkeypatch):
    from halation import editor
    from halation.authoring.preferences import PreferenceStore

    monkeypatch.setenv("HALATION_STATE", str(empty))
    opened = []
    monkeypatch.setattr(editor, "edit", lambda path, bindings, sandbox, lesson: opened.append((path, lesson)))
    assert cli("edit", "--lesson", "adaptation").code == cli("edit", "--lesson", "next").code == 0
    store = PreferenceStore(empty)
    store.change(lessons=("buffers",))
    store.flush()
    assert cli("edit", "--lesson", "next").code == 0
    assert opened == [(None, "adaptation"), (None, "buffers"), (None, "convolution")]
    lines = cli("edit", "--lesson", "list").out.splitlines()
    assert len(lines) == 12 and "buffers" in lines[0] and " done " in lines[0] and " done " not in lines[1]
    refused = cli("edit", "--lesson", "adaption")
    assert refused.code == 2 and "adaption: there is no such lesson" in refused.err and "adaptation" in refused.err
    assert cli("edit", "soft_bloom", "--lesson", "adaptation").code == 2 and len(opened) == 3


def test_a_file_of_that_name_wins(cli, empty, graphs):
    shutil.copy(graphs(), empty / "soft_bloom")
    facts = cli("explain", "soft_bloom", "-i", "beauty=none.exr").err
    assert "none.exr" in facts
    assert set(hal.load("soft_bloom").nodes) == {"light"}
    (empty / "soft_bloom").write_text("{")
    assert cli("check", "soft_bloom").code == 3


def test_a_folder_of_that_name_does_not(cli, empty):
    (empty / "soft_bloom").mkdir()
    assert cli("explain", "soft_bloom").code == 0
    assert "bloom" in hal.load("soft_bloom").nodes
    assert find_graph_or_preset("soft_bloom") == BLOOM  # as a server opens it
    assert cli("check", "soft_bloom", "--json").json["graphs"] == []  # all graphs of the folder


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("soft_blom", "no preset has this name; did you mean 'soft_bloom'?"),
        ("qqqqqqqq", "no preset has this name; halation demo --list prints them"),
        ("acme.dream", "no preset has this name: no plug-in 'acme' is installed, and its presets come with it"),
        ("presets/soft_bloom.json", "; for the preset write soft_bloom"),
        ("soft_bloom.json", "; for the preset write soft_bloom"),
    ],
)
def test_what_is_neither_is_explained(fails, empty, word, hint):
    sentence = fails(3, "render", word)
    assert sentence.startswith(f"{word}: there is no such file") and sentence.endswith(hint)
    with pytest.raises(DocumentError) as fault:
        hal.load(word)
    assert str(fault.value) == sentence


def test_names_of_files_are_left_alone(fails, empty):
    assert fails(3, "render", "mine.json") == "mine.json: there is no such file"
    with pytest.raises(DocumentError, match="there is no such file"):
        hal.load("nothing_of_this_name")


@pytest.fixture
def fresh_plugins():
    """Plug-ins are looked for anew, before and after a test."""
    for cached in (plugins, catalogue):
        cached.cache_clear()
    yield
    for cached in (plugins, catalogue):
        cached.cache_clear()


def test_presets_of_plug_ins(cli, empty, fresh_plugins, monkeypatch, tmp_path):
    """They are named with the namespace; a preset that merely ends so is not meant."""
    package, notes = tmp_path / "acme_haze", tmp_path / "acme_haze-1.0.dist-info"
    for folder in (package / "nodes", package / "presets", notes):
        folder.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "presets" / "ball.json").write_text(json.dumps(NOISE))
    (notes / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-haze\nVersion: 1.0\n")
    (notes / "entry_points.txt").write_text("[halation.nodes]\nacme_haze = acme_haze\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("HALATION_PLUGINS", "acme-haze")
    assert cli("explain", "acme_haze.ball").code == 0
    assert "acme_haze.ball" in cli("demo", "--list").out.split()
    assert cli("explain", "ball").code == cli("explain", "other.ball").code == 3
    assert "did you mean 'acme_haze.ball'?" in cli("explain", "acme_haz.ball").err


def test_the_list(cli):
    names = cli("demo", "--list").out.split()
    assert names == [path.stem for path in presets.paths()]
    assert cli("demo", "--list", "--json").json["presets"]["soft_bloom"] == str(BLOOM)


def test_a_copy_works_by_itself(cli, empty):
    result = cli("demo", "--copy", "looks")
    assert result.code == 0 and "looks/samples/neon.exr" in result.err
    copies = [empty / "looks" / path.name for path in presets.paths()]
    assert all(copy.read_bytes() == path.read_bytes() for copy, path in zip(copies, presets.paths(), strict=True))
    reports = cli("check", "looks", "--strict", "--json")
    assert reports.code == 0 and len(reports.json["graphs"]) == len(copies)
    assert cli("render", "looks/soft_bloom.json", "-i", "looks/samples/neon.exr", "-o", "out.png").code == 0
    assert "Depth" in cli("info", "looks/samples/neon.exr").out


def test_a_copy_replaces_nothing(cli, empty):
    (empty / "soft_bloom.json").write_text("mine")
    result = cli("demo", "--copy", ".")
    assert result.code == 1 and "soft_bloom.json: the file is there already" in result.err
    assert [path.name for path in empty.iterdir()] == ["soft_bloom.json"]
    assert cli("demo", "--copy", "new", "--json").json["copied"]
    assert json.loads((empty / "new" / "soft_bloom.json").read_text())["halation"]
