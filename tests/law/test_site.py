"""The manual as a site: the navigation names every page, and each node has its own.

`./dev site` builds all of it strictly; these tests find the same faults without rendering pictures.
"""

from __future__ import annotations

import logging
import re
import sys
import tomllib
from pathlib import Path

import pytest
from halation.nodes import built_in_nodes
from halation.presets import paths

ROOT = Path(__file__).parents[2]
SITE = ROOT / "tests/site"
FIRST_PAGE_LIMIT = 1_000_000


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, built strictly, with empty pictures of nodes, and without measuring them."""
    from mkdocs.commands.build import build
    from mkdocs.config import load_config

    folder = tmp_path_factory.mktemp("site")
    patch = pytest.MonkeyPatch()
    patch.syspath_prepend(SITE)
    patch.setenv("NO_MKDOCS_2_WARNING", "1")
    import node_pages

    names = [f"pictures/nodes/{name}.jpg" for name in ("sample", "photograph", *built_in_nodes())]
    names += [f"pictures/nodes/{name}.jpg" for name in ("bloom_photograph", "bloom_strip")]
    patch.setattr(node_pages, "render_pictures", lambda nodes: ((name, b"") for name in names))
    patch.setattr(node_pages, "measure_times", lambda nodes: {"bloom": "It takes 80 ms with a device."})
    logging.getLogger("mkdocs").setLevel(logging.INFO)
    try:
        build(load_config(str(SITE / "mkdocs.yml"), site_dir=str(folder)))
    finally:
        patch.undo()
        sys.modules.pop("node_pages", None)
    return folder


def test_each_page_and_each_node_is_there(site: Path) -> None:
    """A dead link, or a page that the navigation does not name, would have stopped the build."""
    pages = {path.stem for path in (ROOT / "docs").glob("*.md")}
    assert pages <= {path.stem for path in site.glob("*.html")}
    assert {path.stem for path in (site / "nodes").glob("*.html")} == set(built_in_nodes())
    assert {path.stem for path in (site / "pictures").glob("*.jpg")} == {path.stem for path in paths()}


def test_a_page_of_a_node_says_what_the_declaration_says(site: Path) -> None:
    page = (site / "nodes/bloom.html").read_text(encoding="utf-8")
    bloom = built_in_nodes()["bloom"]
    assert all(f"<code>{name}</code>" in page for name, value in bloom.values.items() if not value.folded)
    assert bloom.aliases[0] in page and 'href="../presets.html#soft_bloom"' in page
    assert 'id="soft_bloom"' in (site / "presets.html").read_text(encoding="utf-8")
    assert "<td>Nuke</td>" in page and "<td>Glow</td>" in page
    neutral = (site / "nodes/exposure.html").read_text(encoding="utf-8")
    assert "leaves the picture as it is" in neutral and "draws nothing" not in neutral
    assert re.search(r"\d+ passes, and \d+ MiB of textures at 1920 x 1080. It takes 80 ms with a device.", page)
    pictures = re.findall(r'src="../pictures/nodes/(\w+).jpg"', page)
    assert pictures == ["sample", "bloom", "photograph", "bloom_photograph", "bloom_strip"]


def test_the_extra_for_the_manual_draws_every_node() -> None:
    """Its pages render each node, also the one that denoises, where nothing else is installed."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    assert {*extras["denoise"]} < {*extras["docs"]}


def test_bars_in_tables_have_no_backslash(site: Path) -> None:
    page = (site / "command-line.html").read_text(encoding="utf-8")
    assert "<code>half|float</code>" in page.replace("&#124;", "|") and "half\\|" not in page


def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    for name in ("404.html", "index.html", "nodes/bloom.html"):
        text = (site / name).read_text(encoding="utf-8")
        assert not re.findall(r'(?:src|<link rel="stylesheet" href)="https?:[^"]*', text)
        (script,) = re.findall(r'src="([./]*assets/file_search.js)"', text)
        folder = site if script.startswith("/") else (site / name).parent
        assert (folder / script.lstrip("/")).is_file()


def test_the_first_page_is_small(site: Path) -> None:
    text = (site / "index.html").read_text(encoding="utf-8")
    files = {name.split("?")[0] for name in re.findall(r'(?:src|href)="([^":#]+\.(?:js|css|png|jpg))"', text)}
    assert len(files) >= 4
    assert len(text) + sum((site / name).stat().st_size for name in files) <= FIRST_PAGE_LIMIT


def test_pages_have_no_attributes_that_html_does_not_allow(site: Path) -> None:
    """Those that the validator of the W3C has found."""
    for name in ("404.html", "index.html", "nodes/bloom.html"):
        page = (site / name).read_text(encoding="utf-8")
        assert "<label" in page and 'tabindex=""' not in page and "autocorrect=" not in page, name
        assert not re.search(r'<input[^>]*type="checkbox"[^>]*autocomplete|<img[^>]*width="[^"]*%', page), name
