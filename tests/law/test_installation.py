"""pip, pipx and uv each install a working command from the wheel, without a compiler, and each extra works alone."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path

import pytest
from release import DEVELOPMENT_EXTRAS, build_packages
from source_trees import ROOT, copy_tree

UV = Path(sys.executable).with_name("uv")
COMMIT_TIME = 1_700_000_000
EXTRAS = {
    "video": ("render soft_bloom --frames 1-3 --scale 0.25 -o a.mp4", "a.mp4"),
    "denoise": ("render denoised.json -o a.png", "a.png"),
    "cluster": ("render soft_bloom --frames 1-2 --scale 0.25 --cluster local:1 -o a.#.png", "a.2.png"),
    "fit": ("fit cinematic_grade --to picture.png --values contrast --budget 5s -o a.json", "a.json"),
    "wgsl": ("export soft_bloom --to wgsl -o a", "a/wgsl"),
}
"""Each extra with a command that needs it, and what that writes."""

DENOISED = {
    "halation": 1,
    "links": {"clean.image": "noisy.out", "outputs.image": "clean.out"},
    "nodes": {"clean": {"type": "denoise"}, "noisy": {"type": "noise", "values": {}}},
    "outputs": {"image": {"type": "Image"}},
}

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(1800),
    pytest.mark.skipif(not UV.exists(), reason="uv is not installed"),
]


def run(*words: str | Path, folder: Path, fails: bool = False, **variables: Path | str) -> str:
    """What a program prints; the test fails with all of it unless the program ends as it should."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "VIRTUAL_ENV"))}
    environment |= {name: str(value) for name, value in variables.items()}
    ended = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
    assert (ended.returncode != 0) == fails, f"{words}\n{ended.stdout[-6000:]}\n{ended.stderr[-6000:]}"
    return ended.stdout + ended.stderr


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, as a release builds it."""
    folder = tmp_path_factory.mktemp("wheel")
    return build_packages(copy_tree(folder / "tree"), folder, COMMIT_TIME)[1]


def find_missing_extras(halation: Path, folder: Path) -> set[str]:
    """The extras that the command `doctor` does not find; it finds nothing wrong."""
    checks = json.loads(run(halation, "doctor", "--json", folder=folder))["checks"]
    assert not [check for check in checks if check["state"] == "fault"]
    return {check["topic"] for check in checks if check["state"] == "note"} & EXTRAS.keys()


INSTALLERS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "pip": (("{uv}", "venv", "--seed", "{venv}"), ("{venv}/bin/python", "-m", "pip", "install", "{wheel}")),
    "pipx": (("{uv}", "tool", "run", "pipx", "install", "--python", sys.executable, "{wheel}"),),
    "uv": (("{uv}", "tool", "install", "--python", sys.executable, "--no-build", "{wheel}"),),
}


@pytest.mark.parametrize("installer", INSTALLERS)
def test_an_installer_gives_a_working_command(wheel: Path, tmp_path: Path, installer: str) -> None:
    """Nothing is compiled, and no extra comes along."""
    folders = {"UV_TOOL_DIR": tmp_path / "tools", "UV_TOOL_BIN_DIR": tmp_path / "venv/bin"}
    folders |= {"PIPX_HOME": tmp_path / "pipx", "PIPX_BIN_DIR": tmp_path / "venv/bin"}
    for words in INSTALLERS[installer]:
        filled = [word.format(uv=UV, venv=tmp_path / "venv", wheel=wheel) for word in words]
        run(*filled, folder=tmp_path, PIP_ONLY_BINARY=":all:", **folders)
    halation = tmp_path / "venv/bin/halation"
    assert find_missing_extras(halation, tmp_path) == EXTRAS.keys()
    run(halation, "render", "soft_bloom", "-o", "a.png", folder=tmp_path)
    assert (tmp_path / "a.png").stat().st_size > 10_000


@pytest.mark.parametrize("extra", EXTRAS)
def test_an_extra_works_alone(wheel: Path, tmp_path: Path, extra: str) -> None:
    """What needs it says so without it, in plain words, and works with it."""
    run(UV, "venv", "--quiet", "--python", sys.executable, "venv", folder=tmp_path)
    pip = (UV, "pip", "install", "--quiet", "--no-build", "--python", tmp_path / "venv/bin/python")
    halation = tmp_path / "venv/bin/halation"
    run(*pip, wheel, folder=tmp_path)
    (tmp_path / "denoised.json").write_text(json.dumps(DENOISED))
    run(halation, "render", "soft_bloom", "-o", "picture.png", folder=tmp_path)
    command, written = EXTRAS[extra]
    assert f"halation[{extra}]" in run(halation, *command.split(), folder=tmp_path, fails=True)
    run(*pip, f"halation[{extra}] @ {wheel.as_uri()}", folder=tmp_path)
    assert find_missing_extras(halation, tmp_path) == EXTRAS.keys() - {extra}
    run(halation, *command.split(), folder=tmp_path)
    assert (tmp_path / written).exists()


def test_every_extra_for_users_is_tried() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert EXTRAS.keys() == project["optional-dependencies"].keys() - DEVELOPMENT_EXTRAS
