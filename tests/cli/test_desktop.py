"""The files by which a desktop knows Halation: their formats are read by parsers and rules that are not ours."""

from __future__ import annotations

import configparser
import os
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import numpy as np
import OpenImageIO as oiio
import pytest
from halation import desktop, media, presets
from halation.cli import edit
from halation.cli.declarations import list_commands
from halation.cli.man_pages import write_man_pages
from halation.cli.program import app
from halation.desktop import installation
from halation.errors import DeviceError
from halation.nodes import Kind
from halation.resources.sandbox import UNRESTRICTED
from typer.main import get_command

ROOT = Path(__file__).parents[2]
ICONS = ROOT / "app/desktop/icons"
MIME = "{http://www.freedesktop.org/standards/shared-mime-info}"


def read_entry(content: bytes) -> dict[str, str]:
    parser = configparser.RawConfigParser(delimiters=("=",))
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    parser.read_string(content.decode())
    (section,) = parser.sections()
    return dict(parser[section])


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX: a shell reads the quotes")
@pytest.mark.parametrize("folder", ["opt", "my apps", "5%", "a$b`c", 'quo"te', "back\\slash", "d'Arc", "π"])
def test_a_shell_reads_the_command_as_it_was_meant(folder):
    """Quotes in `Exec` are those of a shell, inside a string with escapes of its own, and % stands as %%."""
    program = (f"/{folder}/halation", "-P")
    entry = read_entry(desktop.desktop_entries(program)["applications/halation.desktop"])
    escapes = {"s": " ", "n": "\n", "t": "\t", "r": "\r", "\\": "\\"}  # "Possible value types": no others
    words = re.sub(r"\\(.)", lambda match: escapes[match[1]], entry["Exec"]).replace("%%", "%")
    output = subprocess.run(["sh", "-c", f"printf '%s\\n' {words}"], capture_output=True, text=True, check=True).stdout
    assert output.splitlines() == [*program, "edit", "--show-errors", "%f"]


def test_an_entry_has_what_the_specification_asks_for():
    files = desktop.desktop_entries(("halation",))
    entry = read_entry(files["applications/halation.desktop"])
    assert (entry["Type"], entry["Terminal"]) == ("Application", "false") and entry["Name"] and entry["Icon"]
    assert entry["MimeType"].endswith(";") and "image/x-exr" in entry["MimeType"].split(";")
    thumbnailer = read_entry(files["thumbnailers/halation.thumbnailer"])
    assert {"%i", "%o", "%s"} <= set(thumbnailer["Exec"].split())
    assert set(thumbnailer["MimeType"].split(";")) <= set(entry["MimeType"].split(";"))
    assert f"icons/hicolor/48x48/apps/{entry['Icon']}.png" in files


def find_type(content: bytes) -> str:
    """The type that the rules of our file give to a .json file: of the rules that match, the one with priority."""
    types = ElementTree.fromstring(desktop.desktop_entries(("halation",))["mime/packages/halation.xml"])

    def matches(rule: ElementTree.Element) -> bool:
        first, _, last = rule.attrib["offset"].partition(":")
        value = rule.attrib["value"].encode()
        place = content[int(first) : int(last or first) + len(value)]
        return value in place and (not len(rule) or any(map(matches, rule)))

    fitting = [
        (int(magic.attrib["priority"]), item.attrib["type"])
        for item in types
        for magic in item.iter(f"{MIME}magic")
        if any(map(matches, magic))
    ]
    return max(fitting, default=(0, "none"))[1]


@pytest.mark.parametrize("path", presets.paths(), ids=lambda path: path.stem)
def test_presets_are_graphs(path):
    assert find_type(path.read_bytes()) == "application/x-halation-graph"


@pytest.mark.parametrize("content", [b'{"name": "halation"}', b"[1, 2]", b'\n {"halation_path": 1}', b'{"a": {}}'])
def test_other_json_stays_json(content):
    assert find_type(content) == "application/json"


def test_what_is_installed_is_removed(cli, tmp_path):
    (tmp_path / "applications").mkdir()
    (tmp_path / "applications/other.desktop").write_text("[Desktop Entry]\n")
    written = cli("desktop", "--folder", tmp_path, "--json").json["written"]
    assert {Path(path).relative_to(tmp_path).as_posix() for path in written} == {
        *desktop.desktop_entries(()),
        *(f"man/man1/{name}" for name in write_man_pages()),
    }
    assert all(Path(path).is_file() for path in written)
    assert cli("desktop", "--folder", tmp_path, "--json").json["written"] == written  # a second time changes nothing
    assert cli("desktop", "--folder", tmp_path, "--remove", "--json").json["removed"] == written
    assert not any(Path(path).exists() for path in written)
    assert (tmp_path / "applications/other.desktop").exists()
    assert cli("desktop", "--folder", tmp_path, "--remove").out == "nothing needs to change\n"


def test_a_folder_that_cannot_be_made_is_named(cli, tmp_path):
    (tmp_path / "file").write_text("")
    result = cli("desktop", "--folder", tmp_path / "file")
    assert result.code == 1 and f"{tmp_path / 'file' / 'applications'}: the folder cannot be made" in result.err


def test_icons_are_renders_of_their_graph(cli, tmp_path):
    sizes = sorted(int(path.stem) for path in ICONS.glob("*.png"))
    assert sizes == [16, 32, 48, 64, 128, 256, 512]
    assert (ROOT / "app/editor/assets/app_settings/icon.png").read_bytes() == (ICONS / "128.png").read_bytes()
    for size in (16, 128):
        cli("render", ICONS / "icon.json", "-o", tmp_path / f"{size}.png", "--size", f"{size}x{size}")
        old, new = (oiio.ImageBuf(str(folder / f"{size}.png")).get_pixels(oiio.UINT8) for folder in (ICONS, tmp_path))
        assert old.shape == (size, size, 4) and np.abs(old.astype(int) - new).max() <= 1


def test_thumbnails_of_graphs_and_pictures(cli, tmp_path):
    picture = presets.sample()
    for file in (presets.paths()[0], picture):
        assert cli("thumbnail", file, tmp_path / "t.png", "--size", "96").code == 0
        assert media.read_layer(tmp_path / "t.png", "", Kind.IMAGE, sandbox=UNRESTRICTED).array.shape[:2] == (54, 96)


def test_a_thumbnail_reads_nothing_above_its_folder(cli, tmp_path):
    (tmp_path / "inside").mkdir()
    graph = '{"halation": 1, "nodes": {"a": {"type": "read_image", "values": {"path": "../secret.png"}}}, '
    graph += '"links": {"outputs.x": "a.out"}, "outputs": {"x": {"type": "Image"}}}'
    (tmp_path / "inside/g.json").write_text(graph)
    (tmp_path / "secret.png").write_bytes((ICONS / "16.png").read_bytes())
    result = cli("thumbnail", tmp_path / "inside/g.json", tmp_path / "t.png")
    assert result.code != 0 and "secret.png" in result.err and not (tmp_path / "t.png").exists()


def test_an_error_shows_in_a_window(cli, tmp_path, monkeypatch):
    """Only where the menu of the desktop asks for it: a terminal already shows it."""
    shown, acts = list[str](), list[str]()
    box, tk = ModuleType("tkinter.messagebox"), ModuleType("tkinter")
    box.showerror = lambda title, sentence, parent: shown.append(sentence) or acts.append(title)  # type: ignore[attr-defined]
    window = type("Window", (), {name: lambda self, name=name: acts.append(name) for name in ("withdraw", "destroy")})
    tk.Tk, tk.TclError, tk.messagebox = lambda className: window(), RuntimeError, box  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "tkinter", tk)
    monkeypatch.setitem(sys.modules, "tkinter.messagebox", box)
    missing = tmp_path / "missing.exr"
    assert cli("edit", missing).code == 4 and not shown
    assert cli("edit", "--show-errors", missing).code == 4 and f"{missing}" in shown[0]
    assert acts == ["withdraw", "Halation", "destroy"], "no empty window beside it, and none left"


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX: a program of the desktop is a script")
def test_an_error_shows_where_tk_cannot_start(tmp_path, monkeypatch, capfd):
    """Without its libraries Tk cannot be imported; a program of the desktop shows the error."""
    (tmp_path / "zenity").write_text(
        f'#!/bin/sh\nprintf "%s|" "$@" >"{tmp_path}/shown"\necho warning >&2\necho\nexit 1\n'
    )
    (tmp_path / "zenity").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "tkinter", None)
    desktop.show_error("there is no driver")
    assert (tmp_path / "shown").read_text() == "--error|--no-markup|--text|there is no driver|"
    (tmp_path / "zenity").rename(tmp_path / "xmessage")
    desktop.show_error("-x is odd")
    assert (tmp_path / "shown").read_text() == "-x is odd|"
    (tmp_path / "xmessage").unlink()
    desktop.show_error("nobody sees it")
    assert capfd.readouterr() == ("", ""), "what the programs say is nobody's concern"


def test_a_missing_library_is_named_with_what_to_install():
    fault = edit.name_missing_library(ImportError("libX11.so.6: cannot open shared object file: No such file"))
    assert isinstance(fault, DeviceError) and "no libX11.so.6: install" in str(fault)
    other = ImportError("cannot import name 'a' from 'b'")
    assert edit.name_missing_library(other) is other


def test_a_manual_page_has_all_that_the_help_has(cli):
    """Every flag that the library of the command line shows, and what each means."""
    pages = write_man_pages()
    commands = re.findall(r"halation\\-([\w\\-]+) \(1\)", pages["halation.1"])
    assert {f"halation-{name}.1".replace("\\", "") for name in commands} == set(pages) - {"halation.1"}
    for name, page in pages.items():
        lines = page.splitlines()
        assert all(re.match(r"\.(TH|SH|PP|TP|B|BR)\b", line) for line in lines if line.startswith((".", "'")))
        text = " ".join(re.sub(r"\\f[BIR]|\\&|^\.\w+ ?", "", line) for line in lines)
        text = text.replace("\\-", "-").replace("\\e", "\\")
        words = name.removesuffix(".1").split("-", 1)[1:]
        help = cli(*words, "--help").out.partition("Exit codes:")[0]
        assert set(re.findall(r"--[a-z][\w-]+", help)) - {"--help"} <= set(re.findall(r"--[a-z][\w-]+", text)), name
        command = list_commands()["-".join(words)] if words else get_command(app)
        shown = [item for item in command.params if item.name != "help" and not getattr(item, "hidden", False)]
        assert all(" ".join((item.help or "").split()) in text for item in shown), name


def test_a_desktop_reads_anew_what_was_written_and_what_was_removed(monkeypatch, tmp_path, capfd):
    """Its own programs are run with their folders each time, and a folder that is not there is not told to any."""
    programs, folder, notes = tmp_path / "bin", tmp_path / "share", tmp_path / "notes"
    programs.mkdir()
    parts = {"update-desktop-database": "applications", "update-mime-database": "mime"}
    for name in (*parts, "gtk-update-icon-cache"):
        (programs / name).write_text(f'#!/bin/sh\necho "$(basename "$0") $*" | tee -a {notes}\n')
        (programs / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    files = {"applications/a.desktop": b"1", "mime/packages/a.xml": b"2"}
    expected = sorted(f"{name} {folder / part}" for name, part in parts.items())
    for act in (lambda: installation.install(folder, files), lambda: installation.remove(folder, files)):
        act()
        assert sorted(notes.read_text().splitlines()) == expected and capfd.readouterr().out == ""
        notes.unlink()


def test_only_pictures_that_few_desktops_show_get_thumbnails():
    """Those of the formats of light; freedesktop's own thumbnailers show PNG, JPEG and TIFF."""
    files = desktop.desktop_entries(("halation",))
    types = read_entry(files["thumbnailers/halation.thumbnailer"])["MimeType"].strip(";").split(";")
    assert [kind for kind in types if kind.startswith("image/")] == ["image/x-exr", "image/vnd.radiance"]
