"""The manual as a site: the navigation names every page, and each node has its own.

`./dev site` builds all of it strictly; these tests find the same faults without rendering pictures.
"""

from __future__ import annotations

import logging
import re
import sys
import tomllib
from pathlib import Path
from types import MappingProxyType

import pytest
from browser import CHROMIUM, Browser
from halation.nodes import Filter, Pointwise, built_in_nodes
from halation.presets import paths
from halation.reference.examples import EXAMPLES
from site_check import (
    FIRST_PAGE_LIMIT,
    find_faults_in_html,
    find_faults_on_screen,
    read_pages,
    serve,
    weigh_first_page,
)

ROOT = Path(__file__).parents[2]
SITE = ROOT / "tests/site"
UNCHANGED = MappingProxyType(
    {
        "lut_file": "it needs a file",
        "premultiply": "the sample covers every pixel",
        "sanitize": "the sample is finite",
        "select": "it passes one of its pictures on",
        "temporal_aa": "it joins earlier frames, which a single picture has not",
        "unpremultiply": "the sample covers every pixel",
    }
)
"""Type of node -> why its picture is that before it."""


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
    drawn = dict.fromkeys(names, b""), {"bloom": "It takes 80 ms with a device."}
    patch.setattr(node_pages, "illustrate_nodes", lambda: drawn)
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
    assert "<code>stops</code> at 1.5" in neutral and 'alt="exposure with stops at 1.5"' in neutral
    assert "With these values 1 pass, and" in neutral
    assert "the processor decodes the file" in (site / "nodes/read_image.html").read_text(encoding="utf-8")
    assert re.search(r"\d+ passes, and \d+ MiB of textures at 1920 x 1080. It takes 80 ms with a device.", page)
    pictures = re.findall(r'src="../pictures/nodes/(\w+).jpg"', page)
    assert pictures == ["sample", "bloom", "photograph", "bloom_photograph", "bloom_strip"]


def test_each_node_is_shown_with_values_that_change_something() -> None:
    nodes = built_in_nodes()
    assert not EXAMPLES.keys() - nodes.keys() and not UNCHANGED.keys() - nodes.keys() - EXAMPLES.keys()
    for id, node in nodes.items():
        example = node(**EXAMPLES.get(id, {}))
        if isinstance(example, Pointwise | Filter):
            assert example.identity() is None or id in UNCHANGED, id


def test_pages_have_descriptions_of_their_own(site: Path) -> None:
    pages = read_pages(site)
    assert pages["how-to.html"].description.startswith("Each job is a few lines that work as they stand")
    assert pages["nodes/bloom.html"].description == built_in_nodes()["bloom"].__doc__.partition("\n")[0]
    descriptions = [page.description for page in pages.values()]
    assert not [text for text in descriptions if not 10 <= len(text) <= 160 or re.search(r"[`*]|\]\(", text)]


def test_the_html_of_the_site_has_no_fault(site: Path) -> None:
    """Pictures that the fixture leaves out are missing, and nothing else is."""
    faults = [fault for fault in find_faults_in_html(site, read_pages(site)) if ".jpg" not in fault.detail]
    assert not faults


FAULTS = {
    "language": "<html>",
    "title": "<title></title>",
    "description": '<meta name="description" content="">',
    "headings": "<h1>Another</h1>",
    "network": '<img src="https://a.example/b.png" alt="b">',
    "dead link": '<a href="missing.html">there</a>',
}
SOUND = {
    "language": '<html lang="en">',
    "title": "<title>A page</title>",
    "description": '<meta name="description" content="About it">',
    "headings": "<h1 id='top'>One</h1>",
    "network": '<a href="https://a.example/">elsewhere</a>',
    "dead link": '<a href="#top">up</a> <a href="other.html?a=b#place">there</a>',
}


@pytest.mark.parametrize("rule", ["", *FAULTS])
def test_a_fault_in_html_is_found(tmp_path: Path, rule: str) -> None:
    parts = {**SOUND, **({rule: FAULTS[rule]} if rule in ("language", "title", "description") else {})}
    more = FAULTS.get(rule, "") if parts == SOUND else ""
    (tmp_path / "page.html").write_text("".join(parts.values()) + more)
    other = SOUND | {"title": "<title>Other</title>", "dead link": '<p id="place">'}
    (tmp_path / "other.html").write_text("".join(other.values()))
    faults = list(find_faults_in_html(tmp_path, read_pages(tmp_path)))
    assert [(fault.page, fault.rule) for fault in faults] == ([("page.html", rule)] if rule else [])


@pytest.mark.nightly  # Chromium takes a minute
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_pages_are_accessible_and_load_fast(site: Path, tmp_path: Path) -> None:
    """The first page, one with tables and code, and one of a node; the other ones are for `./dev site --check`."""
    pytest.importorskip("axe_playwright_python", reason="axe-playwright-python is not installed")
    bad = "<style>p { color: #999; background: #fff; width: 2000px }</style><p>dim</p><img src='a.png'><h4>deep</h4>"
    (tmp_path / "bad.html").write_text(bad)
    with Browser() as browser:
        with serve(site) as address:
            assert 300_000 < weigh_first_page(browser, address) <= FIRST_PAGE_LIMIT
            pages = ("index.html", "editor.html", "nodes/bloom.html")
            assert not list(find_faults_on_screen(browser, address, pages))
        with serve(tmp_path) as address:
            rules = {fault.rule for fault in find_faults_on_screen(browser, address, ["bad.html"])}
    assert {"color-contrast", "image-alt", "html-has-lang", "document-title", "width"} <= rules


@pytest.mark.nightly  # Chromium takes a quarter of a minute
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_the_search_works_with_and_without_a_server(site: Path) -> None:
    """A server sends the index of the search only when it is opened."""
    with Browser() as browser, serve(site) as address:
        for page in (f"{address}/index.html", site / "index.html"):
            browser.open(page)
            loaded = "performance.getEntriesByType('resource').filter(entry => /search_index/.test(entry.name)).length"
            assert not isinstance(page, str) or browser.run(loaded) == 0
            browser.run("document.querySelector('#__search').click()")
            browser.run("document.querySelector('[data-md-component=search-query]').focus()")
            browser.wait_until("!/^Init/.test(document.querySelector('.md-search-result__meta').textContent.trim())")
            browser.run(
                "(() => { const query = document.querySelector('[data-md-component=search-query]');"
                "query.value = 'chromatic aberration';"
                "for (const kind of ['input', 'keyup']) query.dispatchEvent(new Event(kind, { bubbles: true })) })()"
            )
            browser.wait_until("document.querySelector('.md-search-result__link')")
            assert "chromatic" in browser.run("document.querySelector('.md-search-result__list').textContent").lower()


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
        (script,) = re.findall(r'src="([./]*assets/site.js)"', text)
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
