"""docs/checking.md says what is true.

HALATION_RENEW=1 python -m pytest tests/lint/test_page.py         makes its table of rules anew
"""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

from halation import document
from halation.lint.checking import RULES

FILE = Path(__file__).parents[2] / "docs" / "checking.md"
PAGE = FILE.read_text(encoding="utf-8")


def test_the_table_has_every_rule_as_it_is() -> None:
    rows = "".join(f"| `{rule.name}` | {rule.severity} | {rule.doc} | {rule.way_out} |\n" for rule in RULES.values())
    old = re.search(r"(^\| `.*\n)+", PAGE, re.M)
    assert old
    if os.environ.get("HALATION_RENEW"):
        FILE.write_text(PAGE.replace(old[0], rows), encoding="utf-8")
    else:
        assert old[0] == rows, "HALATION_RENEW=1 makes the table anew"


def test_the_example_of_settings_is_read_and_names_rules() -> None:
    text = re.search(r"```json\n(\"settings\".*?)```", PAGE, re.S)
    assert text
    allow = document.loads('{"halation": 1, ' + text[1] + "}").settings.allow
    assert {name.partition(":")[0] for name in allow} <= RULES.keys() and len(allow) == 2
    assert json.loads("{" + text[1] + "}")["settings"]["allow"] == dict(allow)


def test_every_rule_it_speaks_of_exists() -> None:
    named = {*re.findall(r"--off ([a-z-]+)", PAGE), *re.findall(r"\[([a-z]+-[a-z-]+)\]$", PAGE, re.M)}
    assert len(named) == 2 and named <= RULES.keys()
