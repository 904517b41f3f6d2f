"""The sample plug-in of the documentation: built as a wheel, installed beside Halation, and used everywhere."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SAMPLE = Path(__file__).parents[2] / "docs" / "sample_plugin"
SEARCH = Path(__file__).parents[1] / "plugin_search.py"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the plug-in as pip installs it from its wheel; nothing is downloaded."""
    folder = tmp_path_factory.mktemp("sample")
    source = shutil.copytree(SAMPLE, folder / "source", ignore=shutil.ignore_patterns("__pycache__"))
    pip = (sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check")
    build = ("wheel", "--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", folder, source)
    subprocess.run([*pip, *build], check=True, capture_output=True)
    (wheel,) = folder.glob("acme_glow-1.2.0-*.whl")
    target = folder / "site"
    subprocess.run([*pip, "install", "--no-deps", "--no-index", "--target", target, wheel], check=True)
    shutil.copytree(SAMPLE / "tests", folder / "tests")
    return target


def python(site: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    """Run Python in an environment in which the plug-in is installed."""
    environment = {**os.environ, "PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        [sys.executable, *words], env=environment, cwd=site.parent, capture_output=True, text=True, timeout=300
    )


def halation(site: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    return python(site, "-c", "from halation.cli import main; main()", *words)


def test_its_own_tests_pass(site: Path) -> None:
    result = python(site, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests")
    assert result.returncode == 0 and "2 passed" in result.stdout, result.stdout + result.stderr


def test_commands_know_it(site: Path) -> None:
    listing = halation(site, "nodes")
    assert "  acme_glow.soft_glow " in listing.stdout and "(acme-glow 1.2.0)" in listing.stdout
    assert listing.stdout.count("\nglow\n") == 1
    page = halation(site, "nodes", "acme_glow.soft_glow")
    assert page.stdout.startswith("acme_glow.soft_glow  (glow, version 1, from acme-glow 1.2.0)"), page.stderr
    facts = json.loads(halation(site, "nodes", "acme_glow.soft_glow", "--json").stdout)
    assert facts["package"] == "acme-glow==1.2.0" and facts["plan"]["passes"]
    markdown = halation(site, "nodes", "--markdown").stdout
    assert "### acme_glow.soft_glow" in markdown and "(#acme_glowsoft_glow)" in markdown


def test_a_graph_with_it_renders(site: Path) -> None:
    preset = site / "acme_glow" / "presets" / "acme_dream.json"
    neon = Path(__file__).parents[2] / "presets" / "samples" / "neon.exr"
    picture = site.parent / "dream.png"
    assert halation(site, "check", "--off", "unbound-input", preset).stdout.strip().endswith(": ok")
    result = halation(site, "render", preset, "-i", f"beauty={neon}", "-o", picture, "--scale", "0.25")
    assert result.returncode == 0 and picture.stat().st_size > 1000, result.stderr


def test_the_editor_finds_it(site: Path) -> None:
    result = python(site, SEARCH)
    assert result.stdout.split("\n")[:5] == [
        "soft glow (acme glow)",
        "soft glow (acme glow)",
        "acme dream",
        "soft_glow",
        "acme_dream",
    ], result.stdout + result.stderr


def test_without_it_the_graph_names_the_package(site: Path, tmp_path: Path) -> None:
    preset = shutil.copy(site / "acme_glow" / "presets" / "acme_dream.json", tmp_path / "dream.json")
    result = halation(tmp_path, "check", preset)
    assert result.returncode == 3
    assert "the plug-in acme-glow 1.2.0, which is not installed: pip install acme-glow==1.2.0" in result.stdout
    before = Path(preset).read_bytes()
    assert halation(tmp_path, "fmt", preset).returncode == 0 and Path(preset).read_bytes() == before


def test_one_that_fails_to_import_is_named(site: Path, tmp_path: Path) -> None:
    broken = shutil.copytree(site, tmp_path / "site")
    (broken / "acme_glow" / "nodes" / "glow" / "soft_glow.py").write_text("import no_such_library\n")
    sentence = "the plug-in acme-glow 1.2.0 cannot be loaded: acme_glow/nodes/glow/soft_glow.py, line 1: "
    nodes = halation(broken, "nodes")
    assert nodes.returncode == 0 and "  bloom " in nodes.stdout and sentence in nodes.stderr
    page = halation(broken, "nodes", "acme_glow.soft_glow")
    assert page.returncode == 2 and sentence in page.stderr
    graph = tmp_path / "plain.json"
    graph.write_text('{"halation": 1}\n')
    check = halation(broken, "check", graph)
    assert check.returncode == 0 and sentence in check.stderr
    report = json.loads(halation(broken, "check", graph, "--json").stdout)
    assert report["refused_plugins"][0]["package"] == "acme-glow"
