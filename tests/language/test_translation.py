"""Texts in the chosen language, and which language the system asks for."""

from __future__ import annotations

import gettext
import subprocess
import sys
from collections.abc import Iterator
from io import BytesIO

import pytest
from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from halation.language import translation
from halation.language.system_language import find_system_language
from halation.language.translation import mark, translate, translate_plural, use_language, use_texts


@pytest.fixture
def french() -> Iterator[None]:
    """A catalogue of three texts, made and read by libraries."""
    catalog = Catalog(locale="fr")
    catalog.mime_headers = [("Plural-Forms", "nplurals=2; plural=(n > 1);")]  # newer versions of Babel have a third
    catalog.add("Open {name}", "Ouvrir {name}")
    catalog.add("view", "vue", context="value")
    catalog.add(("{count} node", "{count} nodes"), ("{count} nœud", "{count} nœuds"))
    compiled = BytesIO()
    write_mo(compiled, catalog)
    compiled.seek(0)
    use_texts("fr", gettext.GNUTranslations(compiled))
    yield
    use_texts("en", None)


def test_english_is_the_code_itself() -> None:
    assert translate("Open {name}", name="a.json") == "Open a.json"
    assert translate("{node.add} adds a node") == "{node.add} adds a node"
    assert translate_plural("{count} node", "{count} nodes", 1) == "1 node"
    assert translate_plural("{count} node", "{count} nodes", 0) == "0 nodes"
    assert mark("Open") == "Open"


@pytest.mark.usefixtures("french")
def test_places_are_filled_in_after_translation() -> None:
    assert translate("Open {name}", name="{braces}.json") == "Ouvrir {braces}.json"
    assert translate_plural("{count} node", "{count} nodes", 1) == "1 nœud"
    assert translate_plural("{count} node", "{count} nodes", 0) == "0 nœud", "French counts none as one"
    assert translate_plural("{count} node", "{count} nodes", 3) == "3 nœuds"


@pytest.mark.usefixtures("french")
def test_a_context_tells_meanings_apart_and_what_is_unknown_stays_english() -> None:
    assert translate("view", "value") == "vue"
    assert translate("view") == translate("view", "menu") == "view"
    assert translate("") == ""


def test_a_language_is_loaded_and_left_again() -> None:
    use_language("de")
    try:
        assert (translate("Save"), translation.language()) == ("Speichern", "de")
    finally:
        use_language("en")
    assert translate("Save") == "Save"


@pytest.mark.parametrize(
    ("variables", "code"),
    [
        ({}, "en"),
        ({"LANG": "de_DE.UTF-8"}, "de"),
        ({"LANG": "de"}, "de"),
        ({"LANG": "de_AT@euro"}, "de"),
        ({"LANG": "C.UTF-8"}, "en"),
        ({"LANG": "xx_XX.UTF-8"}, "en"),
        ({"LC_ALL": "C", "LANG": "de_DE.UTF-8"}, "en"),
        ({"LANGUAGE": "fr:de:en", "LANG": "en_US.UTF-8"}, "de"),
        ({"LC_MESSAGES": "de_CH", "LANG": "en_US.UTF-8"}, "de"),
    ],
)
def test_the_language_of_the_system(monkeypatch, variables: dict[str, str], code: str) -> None:
    """The order of variables is that of GNU gettext, section "Locale Environment Variables" of its manual."""
    for name in ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    for name, text in variables.items():
        monkeypatch.setenv(name, text)
    assert find_system_language(("en", "de")) == code


def test_english_loads_no_catalogue() -> None:
    code = (
        "import sys; from halation.language.translation import translate, use_language; use_language('en');"
        "translate('Save'); print(*sorted({'gettext', 'babel', 'struct'} & set(sys.modules)))"
    )
    result = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=False)
    if result.returncode:  # the package is installed beside the site's packages
        result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "gettext" not in result.stdout.split() and "babel" not in result.stdout.split()
