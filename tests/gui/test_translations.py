"""The editor in a language that nobody speaks: no word has been forgotten, and none is cut or wider than its place."""

from __future__ import annotations

import platform
import re
from collections.abc import Iterator
from pathlib import Path

import OpenImageIO as oiio
import pytest
from drawn_texts import DrawnText, TextRecorder, find_plain_words, is_cut
from gui_driver import Ui
from gui_screens import SCREENS, write_many_things
from halation.editor.window import appearance
from halation.export.kinds import KINDS
from halation.language.translation import translate, use_language, use_texts
from halation.presets import paths
from pseudo_language import PseudoTexts

SIZE = (1366, 768)
"""The smallest screen of laptops."""

BELOW = (
    "' is not linked: it needs an ",
    "link a picture to it",
    "cannot go into",
    "is no Number",
    "the working space, for nothing says otherwise",
    "its header says so",
    "the graphics card is short of memory",
    "float32, color",
    "float16, color",
)
"""Parts of sentences that come from below the editor: those stay English."""

BY_THE_SCREENS = (
    "was changed since it was saved",
    "Save the changes?",
    "Do not save",
    "Choose: ",
    "opened many_things.json",
    "saved many_things.json",
    "has changed on disk and was read again",
    "The picture to work on",
    "Check the highlights",
    "A curve and a color ramp.",
    "A list of lights.",
    "/pictures/",
)
"""What the screens themselves write as a user or as nodes of a plug-in."""

UNITS = ("EV", "W", "sr", "px", "kB", "MB", "ms", "RGB", "RGBA", "Alt", "Tab")
PROGRAMS = ("Halation", "Python", "OpenImageIO", "numpy", "moderngl", "imgui", "bundle", "opencolorio", "Deutsch")
ELSEWHERE = ("Cancel", "Save", "Tint", "Lamps", "curve", "ramp", "samples", "state")
"""Answers that a screen gives to its own question, nodes of its plug-in, and its folders."""

NAMES = frozenset((*UNITS, *PROGRAMS, *ELSEWHERE, *KINDS))


@pytest.fixture
def _speaks_pseudo(monkeypatch) -> Iterator[None]:
    monkeypatch.setattr(appearance, "use_language", lambda _: None)
    use_texts("pseudo", PseudoTexts())
    yield
    use_texts("en", None)


MACHINE_TEXT = re.compile(
    r"\S*[/\\]\S*"  # paths
    r"|[^\s«»]*[._][^\s«»]+"  # names of files, ports and elements
    r"|[^\s«»]+…|#[0-9a-f]{6}|^= .*|.* - Display$"  # names that are cut, colors, expressions, displays
    r"|^[\uf07b\uf0a0\uf1da\uf542]  .*"  # entries of the file browser, by their icons
)


def split(text: str) -> set[str]:
    """The words of a text that have at least two letters."""
    return set(re.findall(r"[^\W\d_]{2,}", text))


def collect_names(ui: Ui, place: Path) -> set[str]:
    """The words of the document, of its files and their layers, and of this machine: they belong to the user.

    So do names of presets, by which commands know them.
    """
    root = ui.session.root
    texts = [ui.session.name, platform.platform(), *(str(facts) for facts in root.ui.values())]
    texts += [*root.nodes, *root.inputs, *root.outputs, *root.controls, *(end.doc for end in root.inputs.values())]
    texts += [path.stem for path in paths()]
    for file in place.rglob("*.exr"):
        picture, part = oiio.ImageInput.open(str(file)), 0
        while picture is not None and picture.seek_subimage(part, 0):
            texts += picture.spec().channelnames
            part += 1
    return set().union(*map(split, texts))


def find_forgotten(drawn: DrawnText, names: set[str]) -> bool:
    """True for a text with words that have not passed through the catalogue."""
    text = MACHINE_TEXT.sub(" ", find_plain_words(drawn.text))
    return not any(part in drawn.text for part in (*BELOW, *BY_THE_SCREENS)) and bool(split(text) - names - NAMES)


@pytest.mark.usefixtures("_speaks_pseudo")
@pytest.mark.parametrize("screen", SCREENS, ids=lambda screen: screen.__name__)
def test_all_that_is_seen_is_translated_and_fits(gui, tmp_path: Path, screen) -> None:
    recorder, wrong = TextRecorder(), list[str]()

    def body(ui: Ui) -> None:
        ui.settled()
        for name in screen(ui):
            recorder.texts.clear()
            ui.wait(2)
            names = collect_names(ui, tmp_path)
            assert recorder.texts
            for drawn in sorted(recorder.texts, key=str):
                if find_forgotten(drawn, names):
                    wrong.append(f"{name}: forgotten: {drawn.text!r}")
                if is_cut(drawn.text):
                    wrong.append(f"{name}: cut: {drawn.text!r}")
                if drawn.excess and "«" in drawn.text:
                    wrong.append(f"{name}: {drawn.excess:.0f} pixels too wide: {drawn.text!r} ({drawn.by})")

    with recorder.record():
        gui(body, write_many_things(tmp_path), size=SIZE, likes={"ui_scale": 1.0}, faulty=True)
    assert not wrong, "\n".join(dict.fromkeys(wrong))


def test_what_is_forgotten_or_cut_is_found() -> None:
    assert find_forgotten(DrawnText("Bad", 0.0, "text"), set())
    assert find_forgotten(DrawnText("«Ĝööđ» and bad", 0.0, "text"), set())
    assert not find_forgotten(DrawnText("«Šéţ bloom.radius» 12 px", 0.0, "text"), set())
    assert not find_forgotten(DrawnText("bloom.radius", 0.0, "text"), {"bloom", "radius"})
    assert is_cut("«Ƒîļ…") and is_cut("…éñ»") and not is_cut("«Ƒîļé «ñöđé»»")


def test_a_language_applies_at_once(gui) -> None:
    """Menus, tabs and nodes follow the preference in the next frames; widgets, docks and the document stay."""
    recorder = TextRecorder()

    def body(ui: Ui) -> None:
        ui.settled()
        before, identity = ui.session.root, ui.ctx.window_info("//Viewer").id_
        seen: dict[str, set[str]] = {}
        for code in ("en", "de", "en"):
            ui.editor.store.change(language=code)
            ui.wait(6)
            recorder.texts.clear()
            ui.wait(2)
            seen[code] = {drawn.text for drawn in recorder.texts}
            assert ui.ctx.window_info("//Viewer").id_ == identity
        assert {"File", "Edit", "Project"} <= seen["en"] and not {"Datei", "Projekt"} & seen["en"]
        assert {"Datei", "Bearbeiten", "Projekt"} <= seen["de"] and not {"File", "Project"} & seen["de"]
        assert ui.session.root is before

    try:
        with recorder.record():
            gui(body)
    finally:
        use_language("en")


def test_the_search_finds_nodes_by_both_names(gui, tmp_path: Path) -> None:
    def body(ui: Ui) -> None:
        ui.settled()
        ui.editor.store.change(language="de")
        ui.wait(4)
        for words in ("gaussian", "Gaußscher", "median"):
            before = set(ui.session.graph.nodes)
            ui.move("Graph", (0.5, 0.9))
            ui.keys("Tab")
            ui.type(words)
            ui.until(lambda before=before: set(ui.session.graph.nodes) > before)
            (added,) = set(ui.session.graph.nodes) - before
            assert ui.session.graph.nodes[added].id == ("median" if words == "median" else "gaussian_blur"), words
        assert translate("gaussian blur", "node") == "Gaußscher Weichzeichner"

    try:
        gui(body, write_many_things(tmp_path))
    finally:
        use_language("en")
