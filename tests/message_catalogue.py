"""The catalogue of all texts of the editor: read off the code and its declarations, as gettext's files.

`./dev renew` writes the template and compiles the languages; `tests/language` compares. Babel knows the formats.
"""

from __future__ import annotations

import ast
import importlib
import pkgutil
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path
from typing import get_args
from unittest.mock import patch

import halation.editor
from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po
from halation import presets
from halation.authoring.edits.align import Side
from halation.authoring.render_queue import RenderState
from halation.document.about import find_about
from halation.document.reading import load
from halation.editor.renders.form import Extent, Sizing
from halation.editor.shared.action import Action
from halation.editor.shared.declared_words import read_paragraphs, spell_out
from halation.editor.shared.window_commands import PanelTitle
from halation.editor.tutorials.course import COURSE
from halation.editor.tutorials.lessons import LESSONS
from halation.editor.viewer.state import MEANINGS
from halation.export.kinds import KINDS
from halation.graph import signature
from halation.graph.model import Missing
from halation.graph.named_items import KIND
from halation.nodes import Items, Kind, Socket, Value, built_in_nodes
from halation.resources.sandbox import UNRESTRICTED

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "app" / "language" / "catalogue"
TEMPLATE = FOLDER / "halation.pot"
ROOMS = ("editor", "authoring", "reference")
"""The floors whose texts are translated."""

FUNCTIONS = {"translate": 1, "translate_label": 1, "mark": 1, "translate_plural": 2, "mark_plural": 2}
"""What takes a text, and how many forms of it."""

_DAY = datetime(2026, 1, 1, tzinfo=UTC)
"""The files say nothing of the day on which they were written, or each writing would change them."""


@dataclass(frozen=True)
class Message:
    """A text for translators: its forms, what tells it from the same text with another meaning, and where it is."""

    forms: tuple[str, ...]
    context: str = ""
    place: str = ""

    @property
    def id(self) -> str | tuple[str, str]:
        """The text as gettext names it."""
        return self.forms[0] if len(self.forms) == 1 else (self.forms[0], self.forms[1])


def list_messages() -> Iterator[Message]:
    """Every text, in an order that keeps those of one place together; some come twice."""
    yield from list_code_messages()
    for group in (_list_actions, _list_editor_words, _list_node_messages, _list_preset_messages, _list_lessons):
        yield from (message for message in group() if any(message.forms))


# --- what the code says ----------------------------------------------------------------------------------------------


def list_code_messages() -> Iterator[Message]:
    """The texts in calls of the functions of the catalogue."""
    for room in ROOMS:
        for path in sorted((ROOT / "app" / room).rglob("*.py")):
            calls = [item for item in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(item, ast.Call)]
            for call in sorted(calls, key=lambda call: (call.lineno, call.col_offset)):
                if (message := read_call(call, path.relative_to(ROOT).as_posix())) is not None:
                    yield message


def read_call(call: ast.Call, place: str) -> Message | None:
    """The text that a call names; None for other calls, and for texts that are written elsewhere."""
    count = FUNCTIONS.get(call.func.id, 0) if isinstance(call.func, ast.Name) else 0
    texts = [item.value for item in call.args if isinstance(item, ast.Constant) and isinstance(item.value, str)]
    if not count or not all(isinstance(item, ast.Constant) for item in call.args[:count]):
        return None
    context = texts[count] if len(texts) > count else ""
    return Message(tuple(texts[:count]), context, place)


# --- what declarations say -------------------------------------------------------------------------------------------


def _list_actions() -> Iterator[Message]:
    for info in sorted(pkgutil.walk_packages(halation.editor.__path__, "halation.editor."), key=lambda info: info.name):
        module = importlib.import_module(info.name)
        for table in vars(module).values():
            for action in table if isinstance(table, tuple) else ():
                if isinstance(action, Action):
                    menus = action.menu.split("/")
                    yield from (Message((text,), "menu", "actions") for text in menus)
                    yield from (Message((text,), place="actions") for text in (action.label, action.doc))


def _list_editor_words() -> Iterator[Message]:
    yield from (Message((title,), place="panels") for title in PanelTitle)
    for context, words in (
        ("state of a render", get_args(RenderState)),
        ("choice", (*get_args(Sizing), *get_args(Extent), *get_args(Missing))),
        ("meaning of data", (meaning for meaning in MEANINGS if meaning != "auto")),
        ("kind", (*Kind, *(kind.lower() for kind in Kind))),
        ("category", ("recent", "group", "graph", "all", "code")),
        ("node", ("code",)),
        ("alignment", get_args(Side)),
    ):
        yield from (Message((word,), context, "words") for word in words)
    yield from (Message((kind.facts.doc,), place="kinds") for kind in Kind)
    yield from (Message((kind.title,), place="export") for kind in KINDS.values())


def _list_node_messages() -> Iterator[Message]:
    for id, kind in built_in_nodes().items():
        place = f"nodes/{kind.category}/{id}"
        yield Message((kind.title,), "node", place)
        yield Message((spell_out(kind.category),), "category", place)
        yield from (Message((paragraph,), place=place) for paragraph in read_paragraphs(kind))
        face = signature(kind())
        for name, socket in (*face.inputs.items(), *face.outputs.items()):
            yield from _list_socket(name, socket, place)
        for value in face.values.values():
            yield from _list_value(value, place)


def _list_socket(name: str, socket: Socket, place: str) -> Iterator[Message]:
    yield Message((spell_out(name),), "value", place)
    yield Message((socket.doc,), place=place)


def _list_value(value: Value, place: str) -> Iterator[Message]:
    yield Message((spell_out(value.label or value.name),), "value", place)
    yield Message((value.doc,), place=place)
    if value.type == "choice":
        yield from (Message((choice,), "choice", place) for choice in value.choices)
    if isinstance(value.items, Items):
        yield Message((value.items.noun,), "item", place)
        yield Message((KIND,), "value", place)
        yield Message((f"What the {value.items.noun} is like.",), place=place)
        for kind in value.items.kinds:
            yield Message((kind.name,), "choice", place)
            yield Message((kind.doc,), place=place)
            for field in kind.declarations:
                yield from _list_value(field, place)


def _list_preset_messages() -> Iterator[Message]:
    for path in sorted(presets.sample().parents[1].glob("*.json")):
        about, place = find_about(load(path, sandbox=UNRESTRICTED)), f"presets/{path.name}"
        yield Message((spell_out(path.stem),), "preset", place)
        yield Message((about.doc,), place=place)
        yield from (Message((tag,), "category", place) for tag in about.tags[:1])


def _list_lessons() -> Iterator[Message]:
    for lesson in (*LESSONS, *COURSE):
        place = f"lessons/{lesson.id}"
        texts = (lesson.title, *(step.sentence for step in lesson.steps))
        yield from (Message((text,), place=place) for text in texts)


# --- files -----------------------------------------------------------------------------------------------------------


def make_template() -> Catalog:
    """The catalogue without translations."""
    catalog = Catalog(
        project="Halation",
        version="",
        header_comment="# The texts of Halation's editor. `./dev renew` writes this file.",
        msgid_bugs_address="",
        last_translator="",
        language_team="",
        creation_date=_DAY,
        revision_date=_DAY,
        fuzzy=False,
    )
    places: dict[tuple[str, str], list[tuple[str, int | None]]] = {}
    for message in list_messages():
        known = places.setdefault((message.forms[0], message.context), [])
        if not known or len(message.forms) > 1:
            catalog.add(message.id, context=message.context or None)
        if (message.place, None) not in known:
            known.append((message.place, None))
    for message in catalog:
        if message.id:
            first = message.id if isinstance(message.id, str) else message.id[0]
            message.locations = places[first, message.context or ""][:2]  # type: ignore[assignment]
    return catalog


def list_languages() -> tuple[str, ...]:
    """The codes of the languages that have a file."""
    return tuple(path.stem for path in sorted(FOLDER.glob("*.po")))


def read_language(code: str) -> Catalog:
    """The translations of a language."""
    with (FOLDER / f"{code}.po").open("rb") as file:
        return read_po(file, locale=code)


def update_language(code: str, template: Catalog) -> Catalog:
    """A language with the texts of the template: new ones are empty, those that are gone are dropped."""
    catalog = read_language(code)
    catalog.update(template, no_fuzzy_matching=True, keep_user_comments=True, update_creation_date=False)
    catalog.obsolete.clear()
    return catalog


def write_catalogue_text(catalog: Catalog) -> str:
    """A catalogue as the text of its file."""
    return _write(lambda file: write_po(file, catalog, width=120, include_lineno=False)).decode("utf-8")


def compile_language(catalog: Catalog) -> bytes:
    """A language as Python's gettext reads it: what is not translated yet is left out, and stays English."""
    return _write(lambda file: write_mo(file, catalog))


def _write(write: Callable[[BytesIO], object]) -> bytes:
    file = BytesIO()
    with patch("babel.messages.catalog.VERSION", "2"):  # headers name it: each version of Babel is to give these bytes
        write(file)
    return file.getvalue()


def renew_catalogue() -> Iterable[str]:
    """Bring all files up to date; gives the paths of those that were not."""
    template = make_template()
    texts = {TEMPLATE: write_catalogue_text(template).encode()}
    for code in list_languages():
        catalog = update_language(code, template)
        texts[FOLDER / f"{code}.po"] = write_catalogue_text(catalog).encode()
        texts[FOLDER / f"{code}.mo"] = compile_language(catalog)
    for path, content in texts.items():
        if not path.is_file() or path.read_bytes() != content:
            path.write_bytes(content)
            yield path.relative_to(ROOT).as_posix()
