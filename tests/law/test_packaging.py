"""What is installed is what is in the tree: source archive, wheel, and a program run from the wheel alone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest
from generated_pages import PACKAGES
from release import build_packages

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
SHIPPED = {
    "app": (
        "**/*.py",
        "py.typed",
        "fit/report.html",
        "language/catalogue/*.mo",
        "regression/report.html",
        "desktop/icons/*",
        "editor/assets/**/*.png",
        "export/assets/*",
        "media/lettering/fonts/*",
    ),
    "nodes": ("**/*.py", "**/*.bin", "py.typed"),
    "shaders": ("__init__.py", "**/*.glsl"),
    "presets": ("__init__.py", "*.json", "samples/*", "pictures/*", "lessons/*"),
}

COMMIT_TIME = 1_700_000_000


@dataclass(frozen=True)
class Built:
    """The wheel, the source archive it was built from, and the wheel unpacked as pip would."""

    wheel: Path
    archive: Path
    target: Path

    def run(self, code: str, cwd: Path) -> str:
        """What `code` prints with only the wheel and the third-party libraries on the path, away from the tree."""
        # -S skips site-packages' .pth files, through which an editable installation would leak in.
        path = os.pathsep.join([str(self.target), sysconfig.get_path("purelib"), sysconfig.get_path("platlib")])
        result = subprocess.run(
            [sys.executable, "-S", "-P", "-c", code],
            cwd=cwd,
            env={**os.environ, "PYTHONPATH": path},
            capture_output=True,
            text=True,
        )
        assert result.returncode == 0, result.stderr
        return result.stdout


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """Build from a copy of the tree, as a release does."""
    folder = tmp_path_factory.mktemp("built")
    archive, wheel = build_packages(copy_shipped(folder / "tree"), folder, COMMIT_TIME)
    python("-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target", folder / "target", wheel)
    return Built(wheel, archive, folder / "target")


def copy_shipped(target: Path) -> Path:
    """Copy what the packages are built from."""
    for top in SHIPPED:
        shutil.copytree(ROOT / top, target / top, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, target / name)
    return target


def python(*words: str | Path) -> None:
    result = subprocess.run([sys.executable, *words], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def shipped() -> set[str]:
    """Paths of the tree, relative to it, that an installation needs."""
    return {
        path.relative_to(ROOT).as_posix()
        for top, patterns in SHIPPED.items()
        for pattern in patterns
        for path in (ROOT / top).glob(pattern)
    }


def origin(name: str) -> str:
    """The path in the tree of a file of the wheel."""
    inside = name.removeprefix("halation/")
    return inside if inside.split("/")[0] in PACKAGES else f"app/{inside}"


def test_every_folder_of_nodes_is_a_package_and_mirrors_its_shaders() -> None:
    menus = {path.parent for path in (ROOT / "nodes").glob("*/*.py")}
    assert all((folder / "__init__.py").is_file() for folder in menus)
    assert not [*(ROOT / "shaders").glob("*/*.py")]


def test_the_wheel_holds_the_tree_and_nothing_else(built: Built) -> None:
    with zipfile.ZipFile(built.wheel) as wheel:
        names = {name for name in wheel.namelist() if ".dist-info/" not in name}
        notes = {name.partition("/")[2] for name in wheel.namelist()} - {name.partition("/")[2] for name in names}
        for name in names:
            assert wheel.read(name) == (ROOT / origin(name)).read_bytes(), name
    assert {origin(name) for name in names} == shipped()
    assert {"METADATA", "entry_points.txt", "licenses/LICENSE"} <= notes


def test_the_source_archive_holds_what_a_build_needs(built: Built) -> None:
    with tarfile.open(built.archive) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {*shipped(), "pyproject.toml", "README.md", "LICENSE"} <= names


def test_the_wheel_finds_its_nodes_shaders_and_presets(built: Built, tmp_path: Path) -> None:
    code = """
from importlib.resources import files
import halation, halation.nodes as nodes
for node in nodes.catalogue().values():
    shader = files("halation.shaders") / node.category / f"{node.id}.glsl"
    print(node.id, len(shader.read_bytes()) if shader.is_file() else 0)
for name in files("halation.presets").iterdir():
    print(name.name, name.is_file() and len(name.read_bytes()))
print(halation.__file__)
"""
    *lines, origin = built.run(code, tmp_path).splitlines()
    assert Path(origin).is_relative_to(built.target)
    sizes = dict(line.rsplit(" ", 1) for line in lines)
    for shader in (ROOT / "shaders").glob("*/*.glsl"):
        if (ROOT / "nodes" / shader.parent.name / f"{shader.stem}.py").is_file():
            assert int(sizes[shader.stem]) == shader.stat().st_size, shader
    assert {path.stem for path in (ROOT / "nodes").glob("[!_]*/[!_]*.py")} <= sizes.keys()
    assert {path.name for path in (ROOT / "presets").glob("*.json")} <= sizes.keys()


def test_the_wheel_has_a_working_command(built: Built, tmp_path: Path) -> None:
    assert PROJECT["project"]["scripts"] == {"halation": "halation.cli:main"}
    code = "import sys; sys.argv = ['halation', 'nodes']; from halation.cli import main; sys.exit(main())"
    listing = built.run(code, tmp_path)
    assert all(path.stem in listing for path in (ROOT / "nodes").glob("[!_]*/[!_]*.py"))


def test_what_the_renderer_exports_is_there() -> None:
    """Its modules are loaded by name when they are wanted."""
    from halation import renderer

    assert all(getattr(renderer, name) is not None for name in renderer.__all__)
    assert set(renderer.__all__) == set(renderer._HOMES)
