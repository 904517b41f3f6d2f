"""The user's library of presets: what is saved, what is found, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import halation as hal
import numpy as np
import pytest
from halation import document, presets
from halation.authoring.commands import AddGroupFile, AddNode
from halation.authoring.edits.element_id import ElementId
from halation.authoring.edits.extracting import extract_graph
from halation.authoring.library import PresetLibrary, find_preset_file, make_preset_name, save_preset, split_tags
from halation.authoring.preferences import PreferenceStore
from halation.authoring.session import Session
from halation.custom_nodes.plugins import is_installed
from halation.document.about import About, read_about
from halation.editor.shared.entries import preset_entries, rank_entries
from halation.errors import DocumentError, GraphError, UsageError
from halation.graph import problems
from halation.resources.sandbox import UNRESTRICTED
from halation.resources.user_folders import own_presets_folder

BLOOM = next(path for path in presets.paths() if path.stem == "soft_bloom")
GRADE = next(path for path in presets.paths() if path.stem == "cinematic_grade")


@pytest.fixture(autouse=True)
def own(monkeypatch, tmp_path: Path) -> Path:
    """The user's own folder of presets, empty."""
    monkeypatch.setenv("HALATION_STATE", str(tmp_path / "state"))
    monkeypatch.delenv("HALATION_PATH", raising=False)
    own_presets_folder().mkdir(parents=True)
    return own_presets_folder()


def load(path: Path) -> hal.Graph:
    return document.load(path, sandbox=UNRESTRICTED)


def save_bloom(path: Path, about: About | None = None) -> None:
    save_preset(load(BLOOM), about or About(), path, None, sandbox=UNRESTRICTED)


def find(name: str):
    return next(preset for preset in PresetLibrary().list_presets() if preset.name == name)


def test_what_is_saved_is_found_by_name_everywhere(own: Path, cli) -> None:
    save_bloom(own / "warm_glow.json", About("Glows warmly.", ("glow", "evening")))
    preset = find("warm_glow")
    assert (preset.about, preset.is_own) == (About("Glows warmly.", ("glow", "evening")), True)
    assert PresetLibrary().list_presets()[0] == preset
    assert set(hal.load("warm_glow").nodes) == {"bloom"}
    assert "warm_glow" in cli("demo", "--list").out.split()
    assert cli("explain", "warm_glow").code == cli("check", "warm_glow").code == 0
    assert "did you mean 'warm_glow'" in cli("explain", "warm_glwo").err


def test_pictures_that_it_reads_are_the_same_files(own: Path, cli, tmp_path: Path) -> None:
    save_bloom(own / "warm_glow.json")
    assert cli("render", "warm_glow", "--scale", "0.1", "-o", str(tmp_path / "out.png")).code == 0


def test_shared_folders(monkeypatch, own: Path, tmp_path: Path) -> None:
    """The user's own first, then those of the preferences, then HALATION_PATH; a shipped name keeps its meaning."""
    folders = [tmp_path / name for name in ("studio", "show", "missing")]
    for folder in folders[:2]:
        folder.mkdir()
        save_bloom(folder / f"{folder.name}_look.json")
        save_bloom(folder / "both.json", About(folder.name))
        save_bloom(folder / "agx_look.json", About("not this one"))
    store = PreferenceStore()
    store.change(preset_folders=[str(folders[0])])
    store.flush()
    monkeypatch.setenv("HALATION_PATH", f"{folders[1]}:{folders[2]}")
    names = {preset.name for preset in PresetLibrary().list_presets()}
    assert {"studio_look", "show_look", "both"} <= names
    assert find("both").about.doc == "studio"
    assert find("agx_look").path.parent == BLOOM.parent
    save_bloom(own / "both.json", About("mine"))
    assert find("both").about.doc == "mine"


def test_tags_and_names_are_searched(own: Path) -> None:
    save_bloom(own / "vesper_glow.json", About("", ("sodium vapour", "evening")))
    entries = preset_entries(PresetLibrary().list_presets())
    for words in ("vesper", "sodium", "vapour", "evening"):
        assert rank_entries(entries, words)[0].title == "vesper glow", words


@pytest.mark.parametrize("text", ["{", "[]", '{"halation": null}', "{}", '{"halation": 1, "ui": 3}', "\udcff"])
def test_a_broken_file_is_one_sentence(own: Path, cli, text: str) -> None:
    (own / "broken.json").write_bytes(text.encode(errors="surrogateescape"))
    preset = find("broken")
    assert preset.fault.startswith(str(own / "broken.json")) and "\n" not in preset.fault
    ended = cli("explain", "broken")
    assert ended.code == 3 and len(ended.err.strip().splitlines()) == 1
    assert find("soft_bloom").fault == ""


@pytest.mark.parametrize("about", [3, [], {"doc": 3, "tags": 4}, {"tags": [1, "x", None]}, {"tags": "abc"}])
def test_strange_descriptions_are_left_out(own: Path, about: object) -> None:
    graph = json.loads(BLOOM.read_text())
    (own / "odd.json").write_text(json.dumps({**graph, "ui": {"about": about}}))
    assert find("odd").about in (About(), About("", ("x",)))
    load(own / "odd.json")


def test_a_file_is_read_again_when_it_changes(own: Path) -> None:
    library = PresetLibrary()
    save_bloom(own / "glow.json", About("one"))
    assert library.list_presets()[0].about.doc == "one"
    save_bloom(own / "glow.json", About("another"))
    assert library.list_presets()[0].about.doc == "another"
    (own / "glow.json").unlink()
    assert library.list_presets()[0].name != "glow"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "type a name"),
        ("  ", "type a name"),
        ("a/b", "use letters"),
        ("../up", "use letters"),
        ("a.b", "use letters"),
        ("-x", "use letters"),
        ("a\nb\0", "use letters"),
        ("CON", "Windows"),
        ("x" * 61, "too long"),
        ("Soft Bloom", "is a preset of Halation"),
    ],
)
def test_names_are_checked(text: str, sentence: str) -> None:
    with pytest.raises(UsageError, match=sentence):
        make_preset_name(text)


def test_names_become_file_names(own: Path) -> None:
    assert make_preset_name("  Warm  Glow ") == "warm_glow"
    assert make_preset_name("Größe-2") == "größe-2"
    (own / "Warm_Glow.json").write_text("{}")
    assert find_preset_file("warm_glow", own) == own / "Warm_Glow.json"
    assert split_tags(" Night,  long  walk, night,,") == ("night", "long walk")


def test_a_selection_works_by_itself() -> None:
    """What it read becomes inputs, also where nothing was linked; what nobody reads in it becomes outputs."""
    session = Session(sandbox=UNRESTRICTED)
    session.files.open(GRADE)
    chain = list(session.graph.nodes)
    for chosen in (*([id] for id in chain), chain):
        graph = extract_graph(session.graph, {ElementId(id) for id in chosen})
        assert set(graph.nodes) == set(chosen) and graph.inputs and graph.outputs, chosen
        assert not [problem for problem in problems(graph) if problem.severity == "error"], chosen
    session.files.new()
    session.apply(AddNode("vignette"))
    graph = extract_graph(session.graph, session.selection)
    assert len(graph.inputs) == len(graph.outputs) == 1 and not list(problems(graph))
    with pytest.raises(GraphError, match="select"):
        extract_graph(session.graph, ())


def test_a_group_alone_gives_its_body(own: Path) -> None:
    session = Session(sandbox=UNRESTRICTED)
    id = session.apply(AddGroupFile(BLOOM))
    graph = extract_graph(session.graph, session.selection)
    assert set(graph.nodes) == {"bloom"} and list(graph.controls) == list(load(BLOOM).controls)
    save_preset(graph, About(), own / "mine.json", np.zeros((18, 32, 3), np.uint8), sandbox=UNRESTRICTED)
    assert session.apply(AddGroupFile(own / "mine.json")) != id
    assert presets.picture(own / "mine.json").is_file()
    save_preset(graph, About(), own / "mine.json", None, sandbox=UNRESTRICTED)
    assert not presets.picture(own / "mine.json").exists()


def test_another_description_replaces_the_old_one(own: Path) -> None:
    save_bloom(own / "one.json", About("text", ("tag",)))
    save_preset(load(own / "one.json"), About(), own / "two.json", None, sandbox=UNRESTRICTED)
    assert read_about(own / "two.json", sandbox=UNRESTRICTED) == About()
    with pytest.raises(DocumentError):
        read_about(Path(__file__), sandbox=UNRESTRICTED)


@pytest.mark.parametrize("is_checkout", [True, False])
def test_presets_of_an_installation_are_not_edited_in_place(tmp_path, monkeypatch, is_checkout):
    """An update would replace them. In a checkout they are files to work on."""
    folder = tmp_path / "halation" / "presets"
    (folder / "samples").mkdir(parents=True)
    (folder / "look.json").write_text("{}")
    monkeypatch.setattr(presets, "sample", lambda: folder / "samples" / "neon.exr")
    if is_checkout:
        (tmp_path / "pyproject.toml").write_text("")
    assert is_installed(folder / "look.json") is not is_checkout
    assert not is_installed(tmp_path / "look.json")
