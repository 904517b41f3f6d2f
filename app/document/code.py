"""Code of nodes: lines of a document, or a file beside it."""

from __future__ import annotations

from pathlib import Path

from msgspec import Struct, field

from ..custom_nodes import Code, CodeFault, CustomNode, Language
from ..errors import DocumentError
from ..resources.sandbox import Sandbox
from . import limits
from .disk import read_text


class CodeTally(Struct):
    """Counts the code of a graph. The same code in many nodes is read once, and counts once."""

    codes: set[Code] = field(default_factory=set[Code])
    letters: int = 0

    def add(self, code: Code) -> str | None:
        """Count the code of a node. Returns why it is refused, or None."""
        if code not in self.codes:
            self.codes.add(code)
            self.letters += max(len(code.text) + len(code.vertex), limits.LEAST_CODE)
        if self.letters <= limits.MAX_CODE:
            return None
        return f"with this node, the code of the graph has more than {limits.MAX_CODE:,} letters; that is no graph"


def read_code_file(language: Language, file: str, folder: str, sandbox: Sandbox) -> Code:
    """The code of a node whose code is in a file. Raises CodeFault for one that cannot be read."""
    path = Path(folder, file)
    return Code(
        language, _text(path, sandbox=sandbox), file, _vertex(path, sandbox=sandbox) if language == "isf" else ""
    )


def describe_code(code: Code) -> dict[str, object]:
    """The record of the code in a document."""
    return {"file": code.file} if code.file else {"code": code.text.split("\n")}


def reread_code(kind: type[CustomNode], folder: str, sandbox: Sandbox) -> Code:
    """The code of a node as its file has it now. Raises CodeFault."""
    code = kind.code
    return read_code_file(code.language, code.file, folder, sandbox=sandbox) if code.file else code


def _vertex(path: Path, sandbox: Sandbox) -> str:
    """The vertex shader that lies beside a shader under the same name, if any does."""
    beside = path.with_suffix(".vs")
    return _text(beside, sandbox=sandbox) if beside.is_file() else ""


def _text(path: Path, sandbox: Sandbox) -> str:
    try:
        return read_text(path, sandbox=sandbox)
    except DocumentError as fault:
        raise CodeFault(0, str(fault)) from None
