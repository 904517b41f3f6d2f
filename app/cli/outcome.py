"""How a command ends: an exit code, and for an error one sentence on standard error, or a JSON object under --json."""

from __future__ import annotations

import contextlib
import errno
import functools
import os
import sys
from collections.abc import Callable
from typing import Any

from ..errors import HalationError, InputError, describe_owner
from ..resources.machine import is_memory_scarce

USAGE = 2
INTERRUPTED = 130
BROKEN_PIPE = 141
BUG = 70
"""Exit codes: 2 as other commands use it, 128 plus the number of a signal as in shells (SIGINT, SIGPIPE), and
EX_SOFTWARE of sysexits.h."""

_NO_MEMORY = (
    "start new thread",
    "failed to map segment",
    "annot allocate memory",
    "bad_alloc",
    "EXR_ERR_OUT_OF_MEMORY",
)
"""What Python, the loader of libraries and C++ say when the system gives them no thread or no memory."""

EXIT_CODES = """\b
Exit codes:
0    success
1    rendering or writing failed; or fmt --check, diff, merge, test, reproduce or bench found a difference
2    the command line is invalid
3    the graph is invalid, or check --strict found warnings
4    a picture cannot be read
5    OpenGL is not usable, a shader was refused or stopped, or the device has no memory left
70   a bug in Halation; HALATION_DEBUG=1 shows where
130  interrupted"""


def catch_faults(command: Callable[..., int]) -> Callable[..., int]:
    """The command, with its exceptions printed and turned into exit codes (see `report_failure`)."""

    @functools.wraps(command)
    def run(*args: Any, **options: Any) -> int:
        try:
            return command(*args, **options)
        except (Exception, KeyboardInterrupt) as fault:
            return report_failure(fault, bool(options.get("as_json")))

    return run


_KINDS = (
    ("int range", "a whole number"),
    ("int", "a whole number"),
    ("float range", "a number"),
    ("float", "a number"),
)
"""What the parser of the command line calls kinds of numbers, longer names first, and what everybody does."""


def report_failure(fault: BaseException, as_json: bool) -> int:
    """Print an error, also as JSON if `as_json`, and return its exit code."""
    if isinstance(fault, BrokenPipeError):
        # The program that read our output has ended, which is not an error of ours.
        _close_output()
        return BROKEN_PIPE
    if isinstance(fault, OSError) and fault.filename is None:
        _close_output()
    _, code, sentence = _describe(fault)
    if code == BUG and os.environ.get("HALATION_DEBUG"):
        raise fault
    with contextlib.suppress(OSError):
        print_note(f"halation: {sentence}")
    if as_json:
        print_json({"error": describe_fault(fault)})
    return code


def describe_fault(fault: BaseException) -> dict[str, Any]:
    """An error for scripts: its class, its sentence and its exit code."""
    kind, code, sentence = _describe(fault)
    return {"kind": kind, "message": sentence, "exit_code": code}


def _describe(fault: BaseException) -> tuple[str, int, str]:
    """Kind, exit code and sentence."""
    if any(words in str(fault) for words in _NO_MEMORY):  # also where a library says so of a file that it reads
        return "MemoryError", 1, "the system gives no more threads or memory (ulimit -u, ulimit -v): allow more"
    if isinstance(fault, HalationError):
        return type(fault).__name__, fault.exit_code, _name_reader(fault)
    if isinstance(fault, KeyboardInterrupt):
        return "Interrupted", INTERRUPTED, "interrupted; no unfinished file is left"
    if isinstance(fault, OSError) and fault.filename is None and fault.errno == errno.EBADF:
        return "OSError", 1, "standard output is closed: the result cannot be printed"
    if isinstance(fault, OSError):  # an OSError without a file is of standard output
        return (
            "OSError",
            1,
            f"{fault.filename or 'standard output'}: the system reports an error: {fault.strerror or fault}",
        )
    if isinstance(fault, MemoryError):
        sentence = str(fault) if type(fault) is MemoryError else ""  # numpy has a class of its own
        sentence = sentence or "there is not enough memory; render a smaller picture with --scale or --size"
        return "MemoryError", 1, sentence
    if format_message := getattr(fault, "format_message", None):  # the parser of the command line raises it
        context = getattr(fault, "ctx", None)
        command = context.command_path if context else "halation"
        text = str(format_message()).strip().rstrip(".")
        for kind, words in _KINDS:
            text = text.replace(f"is not a valid {kind}", f"is not {words}")
        hint = "; pictures are bound with -i NAME=FILE" if "extra argument" in text and " render" in command else ""
        return "UsageError", USAGE, f"{text[:1].lower()}{text[1:]}{hint}; see {command} --help"
    if is_memory_scarce():  # then Python and libraries raise anything, such as errors of syntax
        sentence = f"there is not enough memory ({type(fault).__name__}): allow more (ulimit -v)"
        return "MemoryError", 1, sentence
    text = " ".join(str(fault).split())
    if isinstance(fault, ImportError):
        from halation.nodes import NodeImportError

        if isinstance(fault, NodeImportError):
            return "NodeImportError", 1, text
    return "Bug", BUG, f"this is a bug in Halation ({type(fault).__name__}: {text}); HALATION_DEBUG=1 shows where"


def _name_reader(fault: HalationError) -> str:
    """The sentence of an error; of a picture that cannot be read, also the input or node that reads it."""
    sentence = str(fault)
    owner = describe_owner(fault.node) if isinstance(fault, InputError) and fault.node else ""
    return sentence if owner.partition(" ")[2] in sentence else f"{owner}: {sentence}"


def flush_output(code: int) -> int:
    """Write what is still buffered; the exit code `code`, or that of an error while writing."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OSError as fault:
        return code or report_failure(fault, False)
    return code


def _close_output() -> None:
    """Discard what is still buffered for standard output."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def print_json(item: object) -> None:
    """Print a JSON object to standard output."""
    import json  # most commands print text

    print(json.dumps(item, indent=2, ensure_ascii=False, default=str))


def write_count(count: int, noun: str, plural: str = "") -> str:
    """A count and its noun: `1 pass`, `2 passes`."""
    return f"{count} {noun if count == 1 else plural or f'{noun}s'}"


def print_note(sentence: str) -> None:
    """Print a sentence for the user to standard error, away from the results of the command.

    Its line is written at once: between two writes an interrupt could come, whose own sentence would stand behind it.
    """
    print(f"{sentence}\n", end="", file=sys.stderr, flush=True)
