"""Every exception that Halation raises on purpose.

    HalationError                 one sentence for the user; `exit_code` for the command line
    ├── UsageError           2    the command line or a call makes no sense
    ├── GraphError           3    the graph itself is at fault
    │   └── DocumentError         a graph file cannot be read: names file and JSON path
    ├── InputError           4    a picture that the graph needs cannot be read
    │   └── NoFileError           no file is chosen for a node yet: in the editor this is no fault
    ├── DeviceError          5    no usable OpenGL, or it ran out of something
    │   └── ShaderError           a driver refused a shader: names node, file and line
    └── RenderError          1    the picture was not finished
        └── OutputError           a result cannot be written

Anything else that escapes is a bug.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any


def describe_owner(path: str) -> str:
    """What a sentence calls the owner of a fault: "node 'glow'", "input 'beauty'" for `inputs.beauty`.

    Several nodes, whose work is one pass, stand with commas between: "glow, grade" is "nodes 'glow' and 'grade'".
    """
    *others, last = (f"'{name}'" for name in path.split(", "))
    if others:
        return f"nodes {', '.join(others)} and {last}"
    group, slash, name = path.rpartition("/")
    for end in ("input", "output"):
        if name.startswith(f"{end}s."):
            return f"{end} '{group}{slash}{name[len(end) + 2 :]}'"
    return f"node {last}"


class HalationError(Exception):
    """One sentence that names the file, node and value and says what to do.

    `node` is the node at fault as a path through groups, such as `glow/bloom` or `inputs.beauty`, where it is known;
    for a pass that does the work of several nodes their paths with commas between.
    """

    exit_code = 1

    def __init__(self, sentence: str = "", *, node: str = "") -> None:
        super().__init__(sentence)
        self.node = node


class UsageError(HalationError):
    """The command line or a call makes no sense."""

    exit_code = 2


class GraphError(HalationError):
    """The graph itself is at fault."""

    exit_code = 3


class DocumentError(GraphError):
    """A graph file cannot be read. `path` is the JSON path of the fault, such as `nodes.bloom.values`.

    `rule` is what kind of fault it is, by the name that `halation check` gives it; `line` where it is, if known.
    """

    def __init__(self, file: str, path: str, fault: str, *, rule: str = "schema", line: int = 0) -> None:
        self.file, self.path, self.fault, self.rule, self.line = file, path, fault, rule, line
        super().__init__(": ".join(part for part in (file, path, fault) if part))


class InputError(HalationError):
    """A picture that the graph needs cannot be read."""

    exit_code = 4


class NoFileError(InputError):
    """No file is chosen for a node that reads one. The editor says so where the picture would be, and marks nothing."""


class DeviceError(HalationError):
    """No usable OpenGL, or it ran out of something."""

    exit_code = 5


class ShaderError(DeviceError):
    """A driver refused a shader. `node`, `file` and `line` say where; line 0 stands for the whole file.

    `node` is empty where no node asked for the file yet.
    """

    def __init__(self, node: str, file: str, line: int, fault: str) -> None:
        self.file, self.line, self.fault = file, line, fault
        super().__init__(f"{describe_owner(node)}: {self.sentence}" if node else self.sentence, node=node)

    @property
    def sentence(self) -> str:
        """The fault with its file and line, without the node."""
        place = f"{self.file}, line {self.line}" if self.line else self.file
        return f"{place}: {self.fault}"


class RenderError(HalationError):
    """The picture was not finished."""


class OutputError(RenderError):
    """A result cannot be written."""


def rebuild_fault(facts: Mapping[str, Any]) -> HalationError:
    """The error that another process has described by `kind`, `message` and `exit_code`, in the same class."""
    kind = globals().get(str(facts.get("kind", "")), HalationError)
    if not (isinstance(kind, type) and issubclass(kind, HalationError)):
        kind = HalationError
    fault = kind.__new__(kind)
    HalationError.__init__(fault, str(facts.get("message", "another process failed")))
    fault.exit_code = int(facts.get("exit_code", 1))
    return fault
