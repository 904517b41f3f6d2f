"""The page of `explain --html`: pictures are those of a render, passes those of the plan, and nothing in it runs."""

from __future__ import annotations

import re
from base64 import b64decode
from html import unescape
from html.parser import HTMLParser

import cv2
import numpy as np
import pytest
from halation.glsl import parse

NODES = {
    "blur": {"type": "gaussian_blur", "values": {"sigma": 2.0}},
    "gray": {"type": "luminance"},
    "color": {"type": "saturation", "values": {"saturation": 0.5}},
}
CHAIN = {
    "nodes": NODES,
    "outputs": {"image": {}, "matte": {"type": "Field"}},
    "links": {
        "blur.image": "light.out",
        "gray.image": "blur.out",
        "color.image": "blur.out",
        "outputs.image": "color.out",
        "outputs.matte": "gray.out",
    },
}
HOSTILE = '</title><script>alert(1)</script><img src=x onerror="alert(2)">&amp;'
VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """The elements of a page, their text, and whether each that was begun has ended."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, list[str]] = {}
        self.open: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.setdefault(self.open[-1] if self.open else "", []).append(data)


def pictures_of(page: Page) -> dict[str, list[np.ndarray]]:
    """The pictures by their labels."""
    stored = {
        str(attributes["id"]): b64decode((attributes["href"] or "").removeprefix("data:image/png;base64,"))
        for tag, attributes in page.elements
        if tag == "image"
    }
    pictures: dict[str, list[np.ndarray]] = {}
    label = ""
    for tag, attributes in page.elements:
        label = str(attributes.get("aria-label")) if tag == "svg" else label
        if tag == "use":
            png = stored[str(attributes["href"]).removeprefix("#")]
            picture = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR)
            pictures.setdefault(label, []).append(picture)
    return pictures


@pytest.fixture
def page(cli, graphs, tmp_path) -> Page:
    file = tmp_path / "page.html"
    assert cli("explain", graphs(**CHAIN), "--html", file).code == 0
    return Page(file.read_text("utf-8"))


def test_the_page_is_called_what_its_graph_is_called(page):
    assert page.texts["h1"] == ["Graph"] and page.texts["title"] == ["Graph: passes"]


def test_pictures_are_those_of_a_render(cli, graphs, page, tmp_path):
    out, matte = tmp_path / "out.png", tmp_path / "matte.png"
    files = ("-o", f"image={out}", "-o", f"matte={matte}", "--dither", "none")
    assert cli("render", graphs(**CHAIN), *files).code == 0
    pictures = pictures_of(page)
    expected = cv2.imread(str(out)).astype(int)
    assert np.abs(pictures["color"][-1].astype(int) - expected).max() <= 1
    gray = cv2.imread(str(matte))[..., 0].astype(float)
    stretched = 255.0 * (gray - gray.min()) / (gray.max() - gray.min())
    assert np.abs(pictures["gray"][-1][..., 0] - stretched).max() <= 2.5  # it is stretched before it is rounded


def test_passes_are_those_of_the_plan(cli, graphs, page):
    plan = cli("explain", graphs(**CHAIN), "--json").json
    sections = [attributes.get("id") for tag, attributes in page.elements if tag == "section"]
    assert sections == ["files", *(f"pass-{number}" for number in range(len(plan["passes"])))]
    links = [attributes["href"] for tag, attributes in page.elements if tag == "a"]
    assert {str(link).removeprefix("#") for link in links} <= set(sections)
    assert page.open == []


def test_a_picture_that_several_passes_read_is_in_the_page_once(page, tmp_path):
    text = (tmp_path / "page.html").read_text("utf-8")
    stored = re.findall(
        r'<image id="([^"]+)" width="(\d+)" height="(\d+)" href="data:image/png;base64,([^"]+)"/>', text
    )
    uses = [str(attributes["href"]) for tag, attributes in page.elements if tag == "use"]
    assert text.count("data:image/png") == len(stored) == len({number for number, *_ in stored}) < len(uses)
    assert {f"#{number}" for number, *_ in stored} == set(uses)
    for _, width, height, png in stored:
        picture = cv2.imdecode(np.frombuffer(b64decode(png), np.uint8), cv2.IMREAD_UNCHANGED)
        assert picture.shape[:2] == (int(height), int(width))


def test_programs_can_be_copied_from_the_page(page, tmp_path):
    text = (tmp_path / "page.html").read_text("utf-8")
    programs = [unescape(re.sub(r"<[^>]*>", "", code)) for code in re.findall(r"<pre>(.*?)</pre>", text, re.S)]
    assert programs
    for program in programs:
        assert program.startswith("#version") and parse("program", program).all_functions


def test_what_a_graph_says_is_text(cli, graphs, tmp_path):
    file = tmp_path / "page.html"
    tree = CHAIN | {"ui": {"about": {"doc": HOSTILE, "tags": ["a"]}}}
    assert cli("explain", graphs(**tree), "--html", file).code == 0
    page = Page(file.read_text("utf-8"))
    assert "script" not in {tag for tag, _ in page.elements}
    assert not any(name.startswith("on") for _, attributes in page.elements for name in attributes)
    assert HOSTILE in "".join(page.texts["p"])
    policy = next(attributes for tag, attributes in page.elements if "http-equiv" in attributes)
    assert "default-src 'none'" in str(policy["content"])


def test_it_refuses_what_it_cannot_do(cli, graphs, tmp_path):
    ended = cli("explain", graphs(**CHAIN), "--html", tmp_path / "a.html", "--json")
    assert ended.code == 2 and "--dot, --html and --json: choose one" in ended.err
    ended = cli("explain", graphs(**CHAIN), "--html", tmp_path / "shot.exr" / "a.html")
    assert ended.code == 1 and ended.err.count("\n") == 1
