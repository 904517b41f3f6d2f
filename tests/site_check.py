"""Checks the built manual in a browser: `./dev site --check`, after it has built out/site. Nothing needs a network.

Of every page it reads the HTML: the language, a title and a description of its own, one first heading, links and
anchors that lead somewhere, and nothing that is loaded from elsewhere. Chromium shows the pages at the widths of a
phone, a laptop and a desktop, in the light and in the dark scheme, where axe-core, the engine of Lighthouse's audit of
accessibility, looks for what breaks WCAG 2.2 A and AA (contrast, names of links and buttons, texts of pictures) or its
best practices (order of headings, landmarks). On a phone nothing may make the page wider than the window. The first
page is loaded whole, and its bytes are counted.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib.metadata import distribution
from pathlib import Path
from threading import Thread
from typing import Any, NamedTuple
from urllib.parse import unquote, urldefrag

from browser import CHROMIUM, Browser

ROOT = Path(__file__).parents[1]
FIRST_PAGE_LIMIT = 1_000_000
"""Bytes of the first page with all that it loads."""

SCREENS = {"phone": (390, 844), "laptop": (1366, 768), "desktop": (1920, 1080)}
"""Pixels of CSS: an iPhone 14, and the two sizes of screens that most visitors of the web have besides."""

SCHEMES = {"light": "default", "dark": "slate"}
"""What visitors like better, and what Material calls the colors of that."""

RULES = ("wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice")
"""The sets of rules of axe-core."""

LIKE_OTHERS = 5
"""Of the pages of nodes, which are all made alike, this many are shown; their HTML is read of all."""


class Fault(NamedTuple):
    """What is wrong with a page, and where."""

    page: str
    shown: str
    """The screen and the scheme; empty for what does not depend on them."""
    rule: str
    detail: str


class PageReader(HTMLParser):
    """What is read of the HTML of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.language = self.title = self.description = ""
        self.first_headings = 0
        self.ids = set[str]()
        self.links = list[str]()
        self.loaded = list[str]()
        self._is_title = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: Sequence[tuple[str, str | None]]) -> None:
        """Note what a tag says."""
        named = {name: value or "" for name, value in attrs}
        self.ids |= {named[name] for name in ("id", "name") if named.get(name) and (name == "id" or tag == "a")}
        self.first_headings += tag == "h1"
        self._is_title = tag == "title" and not self.title
        match tag:
            case "html":
                self.language = named.get("lang", "")
            case "meta" if named.get("name") == "description":
                self.description = named.get("content", "")
            case "a" if "href" in named:
                self.links.append(named["href"])
            case "link" if named.get("rel") in ("stylesheet", "icon"):
                self.loaded.append(named["href"])
            case "img" | "script" | "iframe" | "video" | "source" if named.get("src"):
                self.loaded.append(named["src"])

    def handle_data(self, data: str) -> None:
        """Note the title, whose text follows its tag."""
        if self._is_title:
            self.title, self._is_title = data.strip(), False


def read_pages(site: Path) -> dict[str, PageReader]:
    """Every page of a site by its path there. The page of dead links is left out: it has no content."""
    paths = sorted(path for path in site.rglob("*.html") if path.name != "404.html")
    return {path.relative_to(site).as_posix(): PageReader(path.read_text(encoding="utf-8")) for path in paths}


def find_faults_in_html(site: Path, pages: Mapping[str, PageReader]) -> Iterator[Fault]:
    """What is wrong with the HTML of pages."""
    titles: dict[str, str] = {}
    for name, page in pages.items():
        for rule in ("language", "title", "description"):
            if not getattr(page, rule):
                yield Fault(name, "", rule, "the page has none")
        other = titles.setdefault(page.title, name)
        if other != name:
            yield Fault(name, "", "title", f"{other} has the same: {page.title}")
        if page.first_headings != 1:
            yield Fault(name, "", "headings", f"{page.first_headings} first headings")
        for link in page.loaded:
            if "//" in link:
                yield Fault(name, "", "network", f"{link} is loaded from elsewhere")
        for link in dict.fromkeys((*page.links, *page.loaded)):
            if (detail := _follow(site, pages, name, link)) is not None:
                yield Fault(name, "", "dead link", detail)


def _follow(site: Path, pages: Mapping[str, PageReader], name: str, link: str) -> str | None:
    """What is wrong with a link within the site, None if it leads somewhere or elsewhere."""
    path, anchor = urldefrag(link)
    if ":" in path.partition("/")[0] or path.startswith("//"):
        return None
    target = (site / name).parent / unquote(path.partition("?")[0]) if path else site / name
    target = target / "index.html" if target.is_dir() else target
    if not target.is_file():
        return link
    place = target.resolve().relative_to(site.resolve()).as_posix()
    if anchor and place in pages and unquote(anchor) not in pages[place].ids:
        return link
    return None


@contextmanager
def serve(site: Path) -> Iterator[str]:
    """The address of a site, which a server on this machine has meanwhile."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, format: str, *args: object) -> None:
            """Print nothing."""

    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(site)))
    thread = Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


def find_faults_on_screen(
    browser: Browser, address: str, names: Iterable[str], shots: Path | None = None
) -> Iterator[Fault]:
    """What is wrong with pages as a browser shows them, on each screen in each scheme."""
    engine = distribution("axe-playwright-python").locate_file("axe_playwright_python/axe.min.js")
    script = Path(str(engine)).read_text(encoding="utf-8")
    for scheme, colors in SCHEMES.items():
        browser.prefer_scheme(scheme)
        browser.open(f"{address}/index.html")
        browser.run("localStorage.clear(); true")  # Material keeps the colors of the first page that was opened
        for screen, (width, height) in SCREENS.items():
            browser.show_at(width, height, is_phone=screen == "phone")
            for name in names:
                browser.open(f"{address}/{name}")
                browser.run("document.fonts.ready.then(() => true)")
                if (shown := browser.run("document.body.dataset.mdColorScheme")) != colors:
                    yield Fault(name, f"{screen}, {scheme}", "colors", f"the page is shown in {shown}, not in {colors}")
                if shots:
                    browser.take_picture(
                        shots / f"{name.removesuffix('.html').replace('/', '_')}_{screen}_{scheme}.png"
                    )
                for rule, detail in _judge(browser, script):
                    yield Fault(name, f"{screen}, {scheme}", rule, detail)


def _judge(browser: Browser, script: str) -> Iterator[tuple[str, str]]:
    """Which rules the open page breaks, and where."""
    wide = browser.run("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    if wide > 0:
        yield "width", f"the page is {wide} pixels wider than the window"
    yield from (("console", message) for message in browser.messages)
    browser.run(f"{script}; true")
    options = json.dumps({"runOnly": RULES, "resultTypes": ["violations"]})
    report = browser.run(f"axe.run(document, {options}).then(report => JSON.stringify(report.violations))")
    for violation in json.loads(report):
        for node in violation["nodes"]:
            yield violation["id"], f"{' '.join(map(str, node['target']))}: {_explain(node)}"


def _explain(node: Mapping[str, Any]) -> str:
    """What axe-core says of an element, on a line."""
    messages = [check["message"] for kind in ("any", "all", "none") for check in node[kind]]
    return " ".join("; ".join(messages).split())


def weigh_first_page(browser: Browser, address: str) -> int:
    """How many bytes the first page is, with all that it loads."""
    browser.open(f"{address}/index.html")
    code = "['navigation', 'resource'].flatMap(kind => performance.getEntriesByType(kind))"
    return int(browser.run(f"{code}.reduce((sum, entry) => sum + entry.encodedBodySize, 0)"))


def choose_pages(names: Iterable[str]) -> list[str]:
    """The pages that are shown: all, but for most of those that are made alike."""
    names = list(names)
    nodes = [name for name in names if name.startswith("nodes/")]
    shown = set(nodes[:: max(1, len(nodes) // LIKE_OTHERS)][:LIKE_OTHERS])
    return [name for name in names if not name.startswith("nodes/") or name in shown]


def main() -> None:
    """Print what is wrong, and end with 1 if anything is."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("site", nargs="?", type=Path, default=ROOT / "out/site")
    parser.add_argument("--shots", type=Path, help="write a picture of each page on each screen into this folder")
    arguments = parser.parse_args()
    if CHROMIUM is None:
        sys.exit("check: install Chromium first")
    if arguments.shots:
        arguments.shots.mkdir(parents=True, exist_ok=True)
    pages = read_pages(arguments.site)
    if not pages:
        sys.exit(f"check: {arguments.site} has no page: run ./dev site first")
    faults = list(find_faults_in_html(arguments.site, pages))
    shown = choose_pages(pages)
    with serve(arguments.site) as address, Browser() as browser:
        size = weigh_first_page(browser, address)
        if size > FIRST_PAGE_LIMIT:
            faults.append(Fault("index.html", "", "size", f"{size} bytes are more than {FIRST_PAGE_LIMIT}"))
        faults += find_faults_on_screen(browser, address, shown, arguments.shots)
    for fault in faults:
        print("  ".join(filter(None, fault)))
    print(f"{len(pages)} pages read, {len(shown)} of them shown {2 * len(SCREENS)} times; first page {size:,} bytes; "
          f"{len(faults)} faults")  # fmt: skip
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
