"""What MkDocs calls while it builds the manual: adds pages that are generated, and adapts Markdown of the repository.

Pages in docs/ are written for viewers of repositories, which differ from MkDocs in two ways: links may leave docs/, and
what belongs to a list may be indented by less than four spaces. README.md is the first page.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from textwrap import shorten
from typing import Any

from halation.nodes import built_in_nodes
from halation.reference.node_page import find_users
from mkdocs.structure.files import File, Files
from node_pages import illustrate_nodes, write_node_page
from preset_pages import picture_files, write_gallery

ROOT = Path(__file__).parents[2]
FRAME_SCRIPT = "https://unpkg.com/iframe-worker/shim"
"""The one script that Material loads from elsewhere: `site.js` does its work."""

_DESCRIPTION = 160
"""Characters of a description: about what search engines show."""

MENUS = {"aa": "AA"}
"""Menus of nodes whose names are abbreviations."""


def on_config(config: Any) -> Any:
    """Add the page of each node to the navigation, by menus."""
    menus: dict[str, list[Any]] = {}
    for node in built_in_nodes().values():
        menus.setdefault(MENUS.get(node.category, node.category.capitalize()), []).append(
            {node.title: f"nodes/{node.id}.md"}
        )
    for entry in config.nav:
        if "Nodes" in entry:
            entry["Nodes"] = [{"All nodes": "nodes.md"}, *({name: pages} for name, pages in menus.items())]
    return config


def on_files(files: Files, config: Any) -> Files:
    """Add README.md, the pages of nodes, the gallery, and their pictures."""
    for name, content in write_files():
        files.append(File.generated(config, name, content=content))
    return files


def write_files() -> Iterator[tuple[str, str | bytes]]:
    """The name and the content of every file that is generated."""
    yield "index.md", write_first_page()
    for name in ("site.css", "site.js"):
        yield f"assets/{name}", Path(__file__).with_name(name).read_text(encoding="utf-8")
    users = find_users()
    nodes = built_in_nodes()
    pictures, times = illustrate_nodes()
    yield from pictures.items()
    for node in nodes.values():
        yield f"nodes/{node.id}.md", write_node_page(node, users.get(node.id, ()), pictures, times)
    yield "presets.md", write_gallery()
    yield from picture_files()


def write_first_page() -> str:
    """README.md without its large pictures, which other pages show: the first page stays below 1 MB."""
    text = (ROOT / "README.md").read_text(encoding="utf-8").replace("](docs/", "](")
    for name in ("presets.jpg", "nodes.jpg", "editor.png", "editor_light.png"):
        text = re.sub(rf"^!\[.*\]\(images/{re.escape(name)}\)\n\n", "", text, flags=re.M)
    return text


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Adapt a page: links to README.md lead to the first page, and lists are indented as MkDocs needs it."""
    text = re.sub(r"\]\((?:\.\./)+README\.md", "](index.md", markdown)
    text = re.sub(r"\]\((?:\.\./)+docs/", "](../", text) if "/" in page.file.src_uri else text
    page.meta.setdefault("description", describe_page(text))
    return indent_lists(write_bars(text))


def describe_page(markdown: str) -> str:
    """The first sentences of a page, as search engines show them: what is no heading, table, picture or code."""
    blocks = re.split(r"\n{2,}", re.sub(r"```.*?```|<!--.*?-->", "", markdown, flags=re.S))
    texts = (
        block for block in blocks if re.match(r"[\w*\[`(]", block) and not re.match(r"`\w+` in the menu|\[!", block)
    )
    text = re.sub(r"[`*\\]", "", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", next(texts, "Halation")))
    return shorten(text, _DESCRIPTION, placeholder=" ...")


def write_bars(markdown: str) -> str:
    """Markdown in which code in tables has its bars as HTML: MkDocs shows the backslash that others need there."""

    def rewrite(code: re.Match[str]) -> str:
        return f"<code>{escape(code[1]).replace(chr(92) + '|', '&#124;')}</code>"

    return re.sub(r"(?<=[| ,])`([^`\n]*\\\|[^`\n]*)`", rewrite, markdown)


def on_post_page(output: str, page: Any, **_: Any) -> str:
    """Replace the one script that Material loads from elsewhere by ours, so that the site needs no network."""
    own = "../" * page.url.count("/") + "assets/site.js"
    return name_parts(remove_invalid_attributes(output.replace(FRAME_SCRIPT, own)))


def on_post_template(output_content: str, template_name: str, **_: Any) -> str:
    """The page of dead links is a template of Material alone. It names its files from the root of the site."""
    if not template_name.endswith(".html"):
        return output_content
    return name_parts(remove_invalid_attributes(output_content.replace(FRAME_SCRIPT, "/assets/site.js")))


def remove_invalid_attributes(html: str) -> str:
    """A page without the attributes of Material that HTML does not allow where they stand, and that browsers ignore."""
    html = re.sub(r'(<input[^>]*) autocorrect="off"', r"\1", html)
    html = re.sub(r'(<input[^>]* type="(?:checkbox|radio)"[^>]*) autocomplete="off"', r"\1", html)
    return re.sub(r'(<label[^>]*) tabindex=""', r"\1", html)


def name_parts(html: str) -> str:
    """A page that can be read aloud: the dialog of the search has a name, and an empty cell of a table is no head."""
    html = html.replace(
        'data-md-component="search" role="dialog"', 'data-md-component="search" role="dialog" aria-label="Search"'
    )
    return re.sub(r"<th([^>]*)></th>", r"<td\1></td>", html)


def indent_lists(markdown: str) -> str:
    """Markdown with four spaces before what continues a list item, where the source has two or three."""
    lines: list[str] = []
    width = 0
    for line in markdown.split("\n"):
        start = re.match(r"(\d+\. |[-*] )", line)
        if start:
            width = len(start[0])
        elif line and not line.startswith(" "):
            width = 0
        inside = width and line.startswith(" " * width)
        lines.append(" " * (4 - width) + line if inside else line)
    return "\n".join(lines)
