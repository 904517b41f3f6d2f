"""docs/checking.md says what is true."""

from __future__ import annotations

import json
import re
from pathlib import Path

from halation.app import document
from halation.app.lint.checking import RULES

PAGE = (Path(__file__).parents[2] / "docs" / "checking.md").read_text(encoding="utf-8")


def test_the_table_has_every_rule_as_it_is() -> None:
    """Where it is out of date, this is what it should be."""
    rows = [f"| `{rule.name}` | {rule.severity} | {rule.doc} | {rule.way_out} |" for rule in RULES.values()]
    assert re.findall(r"^\| `.*$", PAGE, re.M) == rows, "\n".join(rows)


def test_the_example_of_settings_is_read_and_names_rules() -> None:
    text = re.search(r"```json\n(\"settings\".*?)```", PAGE, re.S)
    assert text
    allow = document.loads('{"halation": 1, ' + text[1] + "}").settings.allow
    assert {name.partition(":")[0] for name in allow} <= RULES.keys() and len(allow) == 2
    assert json.loads("{" + text[1] + "}")["settings"]["allow"] == dict(allow)


def test_every_rule_it_speaks_of_exists(cli_words=re.compile(r"--off ([a-z-]+)|\[([a-z]+-[a-z-]+)\]")) -> None:
    named = {name for pair in cli_words.findall(PAGE) for name in pair if name}
    assert named and named <= RULES.keys()
