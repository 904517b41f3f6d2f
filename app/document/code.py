"""Code of nodes: lines of a document, or a file beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..custom_nodes import Code, CodeFault, CustomNode, Language
from ..errors import DocumentError
from .disk import read_text


def read_code(language: Language, lines: Sequence[str] | None, file: str, folder: str) -> Code:
    """The code of a node. Raises CodeFault for a file that cannot be read."""
    if lines is not None:
        return Code(language, "\n".join(lines))
    path = Path(folder, file)
    return Code(language, _text(path), file, _vertex(path) if language == "isf" else "")


def describe_code(code: Code) -> dict[str, object]:
    """What a document says of it."""
    return {"file": code.file} if code.file else {"code": code.text.split("\n")}


def reread_code(kind: type[CustomNode], folder: str) -> Code:
    """The code of a node as its file has it now. Raises CodeFault."""
    code = kind.code
    return read_code(code.language, None, code.file, folder) if code.file else code


def _vertex(path: Path) -> str:
    """The vertex shader that lies beside a shader under the same name, if any does."""
    beside = path.with_suffix(".vs")
    return _text(beside) if beside.is_file() else ""


def _text(path: Path) -> str:
    try:
        return read_text(path)
    except DocumentError as fault:
        raise CodeFault(0, str(fault)) from None
