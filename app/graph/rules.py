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
    "A node is of a type that is not installed; it is kept, and does nothing.",
    "Correct the type, or update Halation.",
)
MISSING_PLUGIN = Rule(
    "missing-plugin",
    "error",
    "A node comes from a plug-in that is not installed or cannot be loaded; it is kept, and does nothing.",
    "Install the package that is named.",
)
BROKEN_CODE = Rule(
    "broken-code", "error", "The code of a written node says no node.", "Correct the line that is named."
)
BAD_NAME = Rule(
    "bad-name",
    "error",
    "A name could not be told from a path or from an end of the graph.",
    "Leave out dots, slashes and control characters.",
)
BAD_VALUE = Rule(
    "bad-value", "error", "A value is outside its hard range, no choice, or too large.", "Set one that is allowed."
)
UNKNOWN_CONTROL = Rule(
    "unknown-control",
    "error",
    "A group is given a value for a control that it does not have.",
    "Correct the name, or remove the value.",
)
UNLINKED_INPUT = Rule(
    "unlinked-input", "error", "A node that an output needs lacks a picture.", "Link one to its input."
)
UNFINISHED_NODE = Rule(
    "unfinished-node",
    "warning",
    "A node that no output needs lacks a picture.",
    "Link its inputs, or remove it.",
)
BAD_LINK = Rule(
    "bad-link",
    "error",
    "A link starts or ends at nothing, or its ends do not fit each other.",
    "Link to what is there, through a node that converts where one is named.",
)
LOOP = Rule("loop", "error", "Nodes feed each other, so that none can be first.", "Remove one of the links.")
BAD_ANIMATION = Rule(
    "bad-animation",
    "error",
    "Keys or an expression do not fit the value that they move, or need themselves.",
    "Correct what the sentence names.",
)
DEAD_ANIMATION = Rule(
    "dead-animation", "warning", "A value has keys and is linked as well: the link wins.", "Remove one of the two."
)
BACKWARD_FRAMES = Rule("backward-frames", "error", "The frames of the graph end before they begin.", "Swap them.")
DEEP_GROUPS = Rule("deep-groups", "error", "Groups nest too deep.", "Flatten some of them.")
BAD_DEFAULT = Rule(
    "bad-default", "error", "The default of an input does not fit its type.", "Give one number, or one per channel."
)
BAD_CONTROL = Rule(
    "bad-control", "error", "A control points at a value that is not there.", "Point it at one, or remove it."
)
UNFED_OUTPUT = Rule("unfed-output", "error", "Nothing feeds an output.", "Link a node to it, or remove it.")
NO_OUTPUT = Rule(
    "no-output", "warning", "A graph without outputs renders nothing.", "Add an output and link a node to it."
)
UNKNOWN_KEY = Rule(
    "unknown-key",
    "warning",
    "A key means nothing to this version; it is kept, and may be a slip of the pen.",
    "Correct its name, or remove it.",
)
UNMERGED = Rule(
    "unmerged",
    "error",
    "A merge left something to be decided: both sides changed it.",
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
    DEEP_GROUPS,
    BAD_DEFAULT,
    BAD_CONTROL,
    UNFED_OUTPUT,
    NO_OUTPUT,
    UNKNOWN_KEY,
    UNMERGED,
)
"""The rules of `problems`."""
