"""The validator of JSON Schema that tests use, from the package jsonschema."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator


def make_validator(schema: dict[str, Any]) -> Draft202012Validator:
    """A validator for a schema.

    The package looks for others that know more formats of strings. One of them builds its grammar for three seconds of
    processor time in each process that imports it, and no schema of ours asks for what it knows.
    """
    sys.modules.setdefault("rfc3987_syntax", None)  # type: ignore[arg-type]
    from jsonschema import Draft202012Validator

    return Draft202012Validator(schema)
