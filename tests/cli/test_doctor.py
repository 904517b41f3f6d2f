"""`halation doctor`: what is missing on a machine is found and named, with what to do."""

from __future__ import annotations

import json
import shutil
from importlib import metadata

import pytest
from halation.cli import doctor
from halation.media.lettering import fonts
from halation.renderer import open_device
from halation.resources import machine
from halation.resources.sandbox import UNRESTRICTED
from halation.version import VERSION


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    """A home folder, and a machine with a display where everything works."""
    for name in ("HALATION_STATE", "HALATION_PATH", "OCIO"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("DISPLAY", ":0")
    return tmp_path


def states(cli) -> dict[str, tuple[str, str]]:
    """State and sentence by topic; the last of a topic counts."""
    result = cli("doctor", "--json")
    return {item["topic"]: (item["state"], item["sentence"]) for item in json.loads(result.out)["checks"]}


def test_a_machine_that_works(cli):
    result = cli("doctor")
    assert result.code == 0 and "fault" not in result.out
    assert VERSION in result.out and open_device(sandbox=UNRESTRICTED).description in result.out
    assert f"numpy {metadata.version('numpy')}" in result.out


def test_paths_do_not_name_the_user(cli, home):
    result = cli("doctor")
    assert str(home) not in result.out and "~/" in result.out


def test_no_sentence_names_a_user(cli, home, monkeypatch, tmp_path_factory):
    """The home of the account counts too, where the environment names another one, and so do paths inside faults."""
    account = tmp_path_factory.mktemp("anna")
    (account / "scratch").mkdir()
    monkeypatch.setattr(doctor.Path, "expanduser", lambda path: home if str(path) == "~" else account)
    monkeypatch.setenv("TMPDIR", str(account / "scratch"))
    monkeypatch.setattr(doctor.tempfile, "tempdir", None)
    monkeypatch.setenv("OCIO", f"{account}/config.ocio")
    monkeypatch.setenv("HALATION_PATH", "/media/bertha/presets")
    report = cli("doctor").out
    assert str(account) not in report and str(home) not in report and "bertha" not in report
    topics = states(cli)
    assert topics["temporary files"][1].startswith("~/scratch, ") and "~/config.ocio" in topics["color"][1]
    assert topics["shared presets"][1].startswith("/media/.../presets ")


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        ("{home}/a.json and {home}", "~/a.json and ~"),
        ("{home}ward/a.json", "{home}ward/a.json"),
        ("/srv{home}/a.json", "/srv{home}/a.json"),
        (r"C:\Users\carla\a.json: missing", r"C:\Users\...\a.json: missing"),
        ("/run/media/dora/disk/a.json", "/run/media/.../disk/a.json"),
        ("/usr/lib/a.so", "/usr/lib/a.so"),
    ],
)
def test_what_of_a_path_is_hidden(home, sentence, shown):
    assert doctor.hide_users(sentence.format(home=home), doctor.list_homes()) == shown.format(home=home)


def test_a_missing_package_is_named(cli, monkeypatch):
    def find(name: str, found=metadata.version) -> str:
        if name in ("rich", "av"):
            raise metadata.PackageNotFoundError(name)
        return found(name)

    monkeypatch.setattr(metadata, "version", find)
    result = cli("doctor")
    assert result.code == 1
    assert "rich is missing: run pip install --upgrade halation" in result.out
    assert "pip install 'halation[video]'" in result.out


def test_a_config_that_is_missing(cli, monkeypatch):
    monkeypatch.setenv("OCIO", "/nowhere/config.ocio")
    assert cli("doctor").code == 1
    state, sentence = states(cli)["color"]
    assert state == "fault" and "/nowhere/config.ocio" in sentence and "unset OCIO" in sentence


def test_fonts_of_the_system_are_counted(cli, home, monkeypatch):
    shutil.copy(fonts.FONTS / "DejaVuSansMono.ttf", home / "own.ttf")
    monkeypatch.setattr(fonts, "_list_folders", lambda: [str(home)])
    assert states(cli)["fonts"] == ("ok", "DejaVu Sans, and 1 family of this system")
    monkeypatch.setattr(fonts, "FONTS", home / "nowhere")
    fonts._load.cache_clear()
    assert states(cli)["fonts"][0] == "fault"


def test_a_cache_of_shaders_that_is_switched_off(cli, home, monkeypatch):
    monkeypatch.delenv("MESA_SHADER_CACHE_DISABLE", raising=False)
    monkeypatch.setenv("MESA_SHADER_CACHE_DIR", str(home / "cache"))
    state, sentence = states(cli)["shader cache"]
    assert state == "ok" and sentence.startswith("~/cache, ")
    monkeypatch.setenv("MESA_SHADER_CACHE_DISABLE", "true")
    state, sentence = states(cli)["shader cache"]
    assert state == "note" and "unset MESA_SHADER_CACHE_DISABLE" in sentence


def test_no_opengl(cli, monkeypatch):
    from halation import renderer
    from halation.errors import DeviceError

    def refuse(**options: object) -> None:
        raise DeviceError("there is no driver: install one")

    monkeypatch.setattr(renderer, "open_device", refuse)
    assert states(cli)["opengl"] == ("fault", "there is no driver: install one")


def test_no_display_concerns_the_editor_alone(cli, monkeypatch):
    monkeypatch.delenv("DISPLAY")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(machine.sys, "platform", "linux")
    state, sentence = states(cli)["display"]
    assert state == "note" and "rendering works" in sentence and cli("doctor").code == 0


def test_folders_that_cannot_be_used(cli, home, monkeypatch):
    (home / "file").write_text("")
    monkeypatch.setenv("HALATION_STATE", str(home / "file" / "state"))
    monkeypatch.setenv("HALATION_PATH", str(home / "missing"))
    topics = states(cli)
    assert topics["preferences"][0] == "fault" and "~/file/state" in topics["preferences"][1]
    assert topics["shared presets"] == ("note", "~/missing does not exist: see HALATION_PATH")


@pytest.mark.parametrize(("free", "state"), [(5 << 30, "ok"), (100 << 20, "note")])
def test_little_disk_is_noted(cli, monkeypatch, free, state):
    usage = type("Usage", (), {"free": free})
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda path: usage)
    found_state, sentence = states(cli)["temporary files"]
    assert found_state == state and f"{free / 2**30:.1f} GiB free" in sentence
    assert ("make room" in sentence) == (state == "note")


def test_memory_is_the_smaller_of_machine_and_limit(cli, monkeypatch):
    monkeypatch.setattr(doctor, "machine_memory", lambda: 64 << 30)
    monkeypatch.setattr(doctor, "memory_limit", lambda: 1 << 30)
    state, sentence = states(cli)["memory"]
    assert state == "note" and sentence.startswith("1.0 GiB") and "--memory" in sentence


def test_the_version_with_all_that_a_report_needs(cli, home):
    """The same as of doctor, and no path that names the user."""
    result = cli("--version", "--verbose")
    first, *rows = result.out.splitlines()
    assert result.code == 0 and first == f"halation {VERSION}" == cli("--version").out.strip()
    assert [row.split()[1] for row in rows] == [row.split()[1] for row in cli("doctor").out.splitlines()]
    assert "measured" in {row.split()[1] for row in rows} and str(home) not in result.out
    assert cli("--verbose").code == 2
