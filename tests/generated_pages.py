"""Everything in the repository that is generated from the code: `./dev renew` writes it, a law test compares it.

Each entry of PAGES is a file and the function that brings its text up to date. Pages that are only partly generated
have marks around that part, or one table that can be recognized.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

import api_reference
import node_reference
from command_reference import fill_tables
from halation.cli import manual
from halation.graph.expressions.functions import FUNCTIONS
from halation.lint.checking import RULES
from halation.nodes import LIGHTS, built_in_nodes
from halation.reference.facts import format_value
from halation.reference.program_words import PROGRAMS
from message_catalogue import renew_catalogue

ROOT = Path(__file__).parents[1]
PACKAGES = MappingProxyType(
    {"app": "halation", "nodes": "halation.nodes", "shaders": "halation.shaders", "presets": "halation.presets"}
)
"""Top-level folder -> the package that it is."""


_NODE_NAMES = """# Names of nodes in other programs

What a node of another program is called here. Where several nodes are named, the first is the nearest one;
`merge: screen` is `merge` with that mode. The search of the editor finds all of these names. What else is different is
in [coming-from.md](coming-from.md).
"""


def list_packages() -> list[str]:
    """The import names of all folders with code, for setuptools: a package that is not listed is not in the wheel."""
    folders = {path.parent.relative_to(ROOT).parts for top in PACKAGES for path in (ROOT / top).rglob("*.py")}
    return sorted(".".join((PACKAGES[top], *inner)) for top, *inner in folders)


def replace_part(text: str, pattern: str, part: str) -> str:
    """The text with the one part that matches `pattern`, over several lines, replaced."""
    matches = re.findall(pattern, text, re.M | re.S)
    assert len(matches) == 1, f"{len(matches)} places look like {pattern}"
    return re.sub(pattern, lambda _: part, text, flags=re.M | re.S)


def fill_packages(text: str) -> str:
    """pyproject.toml with the list of packages."""
    lines = "".join(f'    "{name}",\n' for name in list_packages())
    return replace_part(text, r"^packages = \[\n.*?^\]\n", f"packages = [\n{lines}]\n")


def fill_table(text: str, head: str, rows: Iterable[Iterable[str]]) -> str:
    """A page with the rows of the table whose first two lines are `head`."""
    lines = "".join(f"| {' | '.join(row)} |\n" for row in rows)
    return replace_part(text, rf"^{re.escape(head)}\n(?:\|[^\n]*\n)+", f"{head}\n{lines}")


def fill_functions(text: str) -> str:
    """docs/time.md with the functions of expressions."""
    head = "| function | gives |\n|---|---|"
    return fill_table(text, head, ((f"`{function.signature}`", function.doc) for function in FUNCTIONS.values()))


def fill_rules(text: str) -> str:
    """docs/checking.md with the rules of `halation check`."""
    rows = ((f"`{rule.name}`", rule.severity, rule.doc, rule.way_out) for rule in RULES.values())
    return fill_table(text, "| rule | severity | what is wrong | what to do |\n|---|---|---|---|", rows)


def fill_light_fields(text: str) -> str:
    """docs/lighting.md with the fields of lights."""
    names = ["kind", *dict.fromkeys(value.name for kind in LIGHTS.kinds for value in kind.declarations)]
    head = "| field | kinds | default | unit | |\n|---|---|---|---|---|"
    return fill_table(text, head, (_describe_light_field(name) for name in names))


def _describe_light_field(name: str) -> tuple[str, ...]:
    """A row of the table of fields: the kinds of light that have it, its default, its unit and its words."""
    if name == "kind":
        words = " ".join(f"`{kind.name}`: {kind.doc[0].lower()}{kind.doc[1:]}" for kind in LIGHTS.kinds)
        return "`kind`", "all", f"`{LIGHTS.kinds[0].name}`", "", words
    kinds = [kind for kind in LIGHTS.kinds if name in kind.fields]
    value = kinds[0].fields[name]
    defaults = {kind.name: format_value(kind.fields[name].default) for kind in kinds}
    others = [f"{default} ({kind})" for kind, default in defaults.items() if default != defaults[kinds[0].name]]
    which = "all" if len(kinds) == len(LIGHTS.kinds) else ", ".join(kind.name for kind in kinds)
    return f"`{name}`", which, ", ".join([defaults[kinds[0].name], *others]), value.unit or "", value.doc


def write_node_names() -> str:
    """docs/node-names.md: what other programs call nodes. Names for the same nodes share a row."""
    parts = [_NODE_NAMES]
    for program, words in PROGRAMS:
        names: dict[str, list[str]] = {}
        for word, wanted in words.items():
            names.setdefault(wanted, []).append(word)
        rows = sorted((", ".join(sorted(same, key=str.lower)), wanted) for wanted, same in names.items())
        lines = (f"| {same} | {_link_nodes(wanted)} |\n" for same, wanted in rows)
        parts.append(f"\n## {program}\n\n| there | here |\n|---|---|\n{''.join(lines)}")
    return "".join(parts)


def write_nodes() -> str:
    """The page of all nodes, with the sheet of their pictures."""
    title, _, rest = manual.catalogue_page(list(built_in_nodes().values())).partition("\n\n")
    return f"{title}\n\n![All nodes at their defaults on the sample frame](images/nodes.jpg)\n\n{rest}"


def _link_nodes(wanted: str) -> str:
    """Links to the nodes that program_words.py names: one with a mode, or several."""
    node, _, mode = wanted.partition(":")
    if node in ("input", "output"):
        return f"[{mode.lower()} {node}](format.md#inputs-and-outputs) of the graph"
    ids = node.split()
    assert set(ids) <= built_in_nodes().keys(), f"program_words.py names a node that does not exist: {wanted}"
    return ", ".join(f"[{id}{': ' if mode else ''}{mode}](nodes.md#{id})" for id in ids)


WHOLE_PAGES: Mapping[str, Callable[[], str]] = MappingProxyType(
    {
        "docs/api.md": api_reference.write_reference,
        "docs/node-names.md": write_node_names,
        "docs/nodes.md": write_nodes,
        "docs/writing-nodes.md": node_reference.write_reference,
    }
)
"""Pages that are generated from the first line to the last."""

PARTS: Mapping[str, Callable[[str], str]] = MappingProxyType(
    {
        "docs/checking.md": fill_rules,
        "docs/command-line.md": fill_tables,
        "docs/fit.md": fill_tables,
        "docs/running.md": fill_tables,
        "docs/lighting.md": fill_light_fields,
        "docs/time.md": fill_functions,
        "pyproject.toml": fill_packages,
    }
)
"""Files with a generated part -> what fills it in."""

PAGES = (*WHOLE_PAGES, *PARTS)


def renew(page: str) -> str:
    """The text of a page as it should be."""
    if page in WHOLE_PAGES:
        return WHOLE_PAGES[page]()
    return PARTS[page]((ROOT / page).read_text(encoding="utf-8"))


def main() -> None:
    """Write the pages that are not up to date, and say which."""
    for page in PAGES:
        path = ROOT / page
        text = renew(page)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
            print(f"{page} is renewed")
    for page in renew_catalogue():
        print(f"{page} is renewed")


if __name__ == "__main__":
    main()
