"""Rules: what can be wrong, each under a name that stays."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

Severity = Literal["error", "warning"]


class Rule(Struct, frozen=True):
    """One thing that can be wrong. `doc` is a sentence about why it matters, `way_out` one about what to do.

    An error keeps a graph, or that part of it, from rendering; a warning does not.
    """

    name: str
    severity: Severity
    doc: str
    way_out: str


UNKNOWN_TYPE = Rule(
    "unknown-type",
    "error",
    "A node has a type that is not installed. It is kept, but has no effect.",
    "Correct the type, or update Halation.",
)
MISSING_PLUGIN = Rule(
    "missing-plugin",
    "error",
    "A node comes from a plug-in that is not installed or cannot be loaded. It is kept, but has no effect.",
    "Install the package that is named.",
)
BROKEN_CODE = Rule(
    "broken-code", "error", "The code of a glsl or isf node is invalid.", "Correct the line that is named."
)
BAD_NAME = Rule(
    "bad-name",
    "error",
    "A name could be confused with a path or with an input or output of the graph.",
    "Leave out dots, slashes and control characters.",
)
BAD_VALUE = Rule(
    "bad-value",
    "error",
    "A value is outside its hard range, not one of its choices, or too large.",
    "Set an allowed value.",
)
UNKNOWN_CONTROL = Rule(
    "unknown-control",
    "error",
    "A group is given a value for a control that it does not have.",
    "Correct the name, or remove the value.",
)
UNLINKED_INPUT = Rule("unlinked-input", "error", "An input of a node that an output needs is not linked.", "Link it.")
UNFINISHED_NODE = Rule(
    "unfinished-node",
    "warning",
    "An input of a node that no output needs is not linked.",
    "Link its inputs, or remove it.",
)
BAD_LINK = Rule(
    "bad-link",
    "error",
    "A link starts or ends at a node or socket that does not exist, or its ends do not fit each other.",
    "Link existing sockets; if the message names a node that converts, put it in between.",
)
LOOP = Rule("loop", "error", "Links form a loop, so that no node can be computed first.", "Remove one of the links.")
BAD_ANIMATION = Rule(
    "bad-animation",
    "error",
    "Keys or an expression do not fit their value, or depend on themselves.",
    "Correct what the message names.",
)
DEAD_ANIMATION = Rule(
    "dead-animation", "warning", "A value has keys and a link: the keys have no effect.", "Remove one of them."
)
BACKWARD_FRAMES = Rule(
    "backward-frames", "error", "The last frame of the graph is before its first frame.", "Swap them."
)
HUGE_CANVAS = Rule(
    "huge-canvas", "error", "The canvas is longer on a side than any picture may be.", "Give it fewer pixels."
)
DEEP_GROUPS = Rule("deep-groups", "error", "Groups are nested too deep.", "Flatten some of them.")
BAD_DEFAULT = Rule(
    "bad-default", "error", "The default of an input does not fit its type.", "Give one number, or one per channel."
)
BAD_CONTROL = Rule(
    "bad-control", "error", "A control points at a value that does not exist.", "Correct its target, or remove it."
)
UNFED_OUTPUT = Rule("unfed-output", "error", "An output is not linked.", "Link a node to it, or remove it.")
NO_OUTPUT = Rule(
    "no-output", "warning", "A graph without outputs renders nothing.", "Add an output and link a node to it."
)
UNKNOWN_KEY = Rule(
    "unknown-key",
    "warning",
    "This version does not know a key. It is kept; it may be a typing error.",
    "Correct its name, or remove it.",
)
UNMERGED = Rule(
    "unmerged",
    "error",
    "A merge has a conflict: both sides changed a part.",
    "Choose a side with halation merge --resolve.",
)

RULES = (
    UNKNOWN_TYPE,
    MISSING_PLUGIN,
    BROKEN_CODE,
    BAD_NAME,
    BAD_VALUE,
    UNKNOWN_CONTROL,
    UNLINKED_INPUT,
    UNFINISHED_NODE,
    BAD_LINK,
    LOOP,
    BAD_ANIMATION,
    DEAD_ANIMATION,
    BACKWARD_FRAMES,
    HUGE_CANVAS,
    DEEP_GROUPS,
    BAD_DEFAULT,
    BAD_CONTROL,
    UNFED_OUTPUT,
    NO_OUTPUT,
    UNKNOWN_KEY,
    UNMERGED,
)
"""The rules of `problems`."""
