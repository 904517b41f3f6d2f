"""How a command ended, for tests that run the command line inside their own process."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest
from halation.cli.program import run


@dataclass(frozen=True)
class Result:
    """How a command ended and what it said."""

    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)


Cli = Callable[..., Result]


def make_cli(capfd: pytest.CaptureFixture[str], *before: str) -> Cli:
    """What runs a command whose first words are `before`, and tells how it ended."""

    def run_command(*words: object) -> Result:
        capfd.readouterr()
        code = run([*before, *map(str, words)])
        output = capfd.readouterr()
        return Result(code, output.out, output.err)

    return run_command
