"""All words of the editor come from its catalogue, and each language has all of them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import message_catalogue
import pytest
from babel.messages.catalog import Message as Translation
from drawn_texts import LABELS, TEXTS
from halation.language.translation import LANGUAGES
from halation.nodes import Value, built_in_nodes
from message_catalogue import FUNCTIONS, ROOT, list_languages, make_template, read_language

SHOWING = {
    **dict.fromkeys(LABELS, (0,)),
    **{name: (index,) for name, index in TEXTS.items()},
    "input_text_with_hint": (1,),
    "quiet_button": (1, 3),
    "main_button": (1,),
    "dropdown": (1, 3),
    "draw_dim": (1,),
    "draw_wrapped": (1,),
    "tip": (0,),
    "show_tip": (0,),
    "draw_empty_panel": (2, 3),
    "draw_badge": (2,),
    "draw_label": (2,),
    "label": (0,),
    "note": (0,),
    "field_note": (0,),
    "icon": (2,),
    "draw_heading": (0, 1),
    "wide_button": (0, 2),
    "Question": (0, 1),
    "Browse": (0,),
    "Edited": (0,),
    "UsageError": (0,),
    "GraphError": (0,),
}
"""Functions that show a text, or keep it to be shown -> which of their arguments are texts."""

NAMES = {"Halation", "shot.####.exr"}
"""What has no translation: names, and what is typed into files."""

SAME_PLACES = re.compile(r"\{[^}]*\}")


@pytest.fixture(scope="module")
def template():
    return make_template()


def list_shown_literals(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Words that are shown although they have not passed through the catalogue, with their lines."""
    for call in (item for item in ast.walk(tree) if isinstance(item, ast.Call)):
        function = call.func
        name = function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")
        for index in SHOWING.get(name, ()):
            if index < len(call.args):
                yield from ((call.lineno, word) for word in list_words(call.args[index]))


def is_word(text: str) -> bool:
    """False for signs, single letters and endings of files."""
    return bool(re.search(r"[^\W\d_]{2}", text)) and not re.fullmatch(r"\.\w+", text)


def list_words(item: ast.AST) -> Iterator[str]:
    """The literal words of an expression, without those inside of calls and of ids behind ##."""
    if isinstance(item, ast.Call | ast.Subscript | ast.Compare):
        return
    if isinstance(item, ast.JoinedStr):
        texts = [part.value if isinstance(part, ast.Constant) else "{}" for part in item.values]
        shown = "".join(map(str, texts)).partition("##")[0]
        yield from (word for word in shown.split("{}") if is_word(word))
        return
    if isinstance(item, ast.Constant) and isinstance(item.value, str) and item.value not in NAMES:
        yield from (word for word in [item.value.partition("##")[0]] if is_word(word))
    for part in ast.iter_child_nodes(item):
        yield from list_words(part)


def test_the_search_finds_what_was_forgotten() -> None:
    code = "imgui.text('Bad')\ntip(f'{count} bad ones')\nquiet_button(s, icon, 'place', 'Bad' if x == 'fine' else y)\n"
    good = (
        "imgui.text(translate('Good'))\nimgui.button(f'##fine {id}')\nquiet_button(s, icon, 'place', translate('Good'))"
    )
    assert [word for _, word in list_shown_literals(ast.parse(code))] == ["Bad", " bad ones", "Bad"]
    assert not list(list_shown_literals(ast.parse(good)))


def test_no_text_is_shown_that_is_not_in_the_catalogue() -> None:
    files = [path for room in message_catalogue.ROOMS for path in sorted((ROOT / "app" / room).rglob("*.py"))]
    forgotten = [
        f"{path.relative_to(ROOT)}:{line}: {word!r}"
        for path in files
        for line, word in list_shown_literals(ast.parse(path.read_text("utf-8")))
    ]
    assert not forgotten, "pass these through `translate`:\n" + "\n".join(forgotten)


def test_texts_are_translated_before_their_places_are_filled_in() -> None:
    """An f-string would look up a text that no catalogue has."""
    wrong = [
        f"{path.relative_to(ROOT)}:{call.lineno}"
        for room in message_catalogue.ROOMS
        for path in sorted((ROOT / "app" / room).rglob("*.py"))
        for call in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in FUNCTIONS
        if any(isinstance(item, ast.JoinedStr) for item in call.args)
    ]
    assert not wrong


def test_the_files_are_up_to_date(template) -> None:
    current = {message_catalogue.TEMPLATE: message_catalogue.write_catalogue_text(template).encode()}
    for code in list_languages():
        catalog = message_catalogue.update_language(code, template)
        folder = message_catalogue.FOLDER
        current[folder / f"{code}.po"] = message_catalogue.write_catalogue_text(catalog).encode()
        current[folder / f"{code}.mo"] = message_catalogue.compile_language(catalog)
    stale = [path.name for path, content in current.items() if path.read_bytes() != content]
    assert not stale, f"not up to date: {stale}; ./dev renew writes them, then translate what is empty in the .po files"


def test_each_language_that_can_be_chosen_has_a_catalogue() -> None:
    assert {*list_languages(), "en"} == set(LANGUAGES)


def list_translations(code: str) -> list[Translation]:
    return [message for message in read_language(code) if message.id]


def forms(text) -> tuple[str, ...]:
    """The forms of a text: one, or those for one and for many."""
    return (text,) if isinstance(text, str) else tuple(text or ())


def is_translated(message: Translation) -> bool:
    return bool(forms(message.string)) and all(forms(message.string))


@pytest.mark.parametrize("code", list_languages())
def test_a_language_has_all_texts(code: str, is_nightly: bool) -> None:
    """But for those of nodes by day: who adds a node need not speak German. The editor shows them in English."""
    messages = list_translations(code)
    assert len(messages) > 1000
    empty = [
        message.id
        for message in messages
        if not is_translated(message)
        and (is_nightly or not all(file.startswith("nodes/") for file, _ in message.locations))
    ]
    assert not empty, (
        f"{len(empty)} texts of app/language/catalogue/{code}.po have no translation: write them there, then "
        f"./dev renew: {empty[:20]}"
    )
    assert not [message.id for message in messages if message.fuzzy]


@pytest.mark.parametrize("code", list_languages())
def test_a_translation_has_the_places_of_its_text(code: str) -> None:
    wrong = [
        (original, translated)
        for message in filter(is_translated, list_translations(code))
        for original, translated in zip(forms(message.id), forms(message.string), strict=True)
        if sorted(SAME_PLACES.findall(original)) != sorted(SAME_PLACES.findall(translated))
        and not (len(forms(message.id)) > 1 and set(SAME_PLACES.findall(translated)) <= {"{count}"})
    ]
    assert not wrong


@pytest.mark.parametrize("code", list_languages())
def test_a_translation_begins_and_ends_as_its_text(code: str) -> None:
    """With the same spaces, line breaks and marks at the end: texts are put together."""
    wrong = []
    for message in filter(is_translated, list_translations(code)):
        for original, translated in zip(forms(message.id), forms(message.string), strict=True):
            ends = [re.sub(r"\S(.*\S)?", "|", text, flags=re.S) for text in (original, translated)]
            marks = [text.rstrip()[-1:] in ".!?:" for text in (original, translated)]
            if ends[0] != ends[1] or marks[0] != marks[1] or original.count("\n") != translated.count("\n"):
                wrong.append((original, translated))
    assert not wrong


@pytest.mark.parametrize("code", list_languages())
def test_choices_of_a_value_have_different_names(code: str) -> None:
    """A list shows them by their names, and the chosen one is found by its name."""
    names = {message.id: message.string for message in list_translations(code) if message.context == "choice"}

    def check(value: Value, place: str) -> list[str]:
        shown = [names.get(choice) or choice for choice in value.choices] if value.type == "choice" else []
        return [f"{place}.{value.name}: {name}" for name in set(shown) if shown.count(name) > 1]

    twice = [
        line for id, kind in built_in_nodes().items() for value in kind.values.values() for line in check(value, id)
    ]
    assert not twice


def test_the_catalogue_lies_with_the_package() -> None:
    assert Path(message_catalogue.FOLDER).is_relative_to(ROOT / "app" / "language")
