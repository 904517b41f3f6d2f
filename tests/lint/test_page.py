"""What docs/checking.md says is true; its table of rules is generated."""

from __future__ import annotations

import json
import re
from pathlib import Path

from halation import document
from halation.lint.checking import RULES
from halation.resources.sandbox import UNRESTRICTED

PAGE = (Path(__file__).parents[2] / "docs" / "checking.md").read_text(encoding="utf-8")


def test_the_example_of_settings_is_read_and_names_rules() -> None:
    text = re.search(r"```json\n(\"settings\".*?)```", PAGE, re.S)
    assert text
    allow = document.loads('{"halation": 1, ' + text[1] + "}", sandbox=UNRESTRICTED).settings.allow
    assert {name.partition(":")[0] for name in allow} <= RULES.keys() and len(allow) == 2
    assert json.loads("{" + text[1] + "}")["settings"]["allow"] == dict(allow)


def test_every_rule_it_speaks_of_exists() -> None:
    named = {*re.findall(r"--off ([a-z-]+)", PAGE), *re.findall(r"\[([a-z]+-[a-z-]+)\]$", PAGE, re.M)}
    assert len(named) == 2 and named <= RULES.keys()
