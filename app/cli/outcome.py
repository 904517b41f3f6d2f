"""How a command ends: one sentence on standard error or one JSON object, and the right exit code."""

from __future__ import annotations

import contextlib
import functools
import json
import os
import sys
from collections.abc import Callable
from typing import Any

from ..errors import HalationError

USAGE = 2
INTERRUPTED = 130
BROKEN_PIPE = 141
BUG = 70

EXIT_CODES = """\b
Exit codes:
0    done
1    rendering or writing failed; fmt --check, diff, merge, test, reproduce or bench found something
2    the command line makes no sense
3    the graph is at fault; check --strict found something to warn of
4    a picture cannot be read
5    no usable OpenGL, a shader was refused, or the device is full
130  interrupted"""


def catch_faults(command: Callable[..., int]) -> Callable[..., int]:
    """Turn what a command raises into a sentence and an exit code; under `--json` into an object as well."""

    @functools.wraps(command)
    def run(*args: Any, **options: Any) -> int:
        try:
            return command(*args, **options)
        except (Exception, KeyboardInterrupt) as fault:
            return report_failure(fault, bool(options.get("as_json")))

    return run


def report_failure(fault: BaseException, as_json: bool) -> int:
    """Say what went wrong; the exit code for it."""
    if isinstance(fault, BrokenPipeError):
        # Whoever read our output has gone: that is no fault of ours, and nothing can be said to them.
        _close_output()
        return BROKEN_PIPE
    if isinstance(fault, OSError) and fault.filename is None:
        _close_output()
    kind, code, sentence = _describe(fault)
    if code == BUG and os.environ.get("HALATION_DEBUG"):
        raise fault
    with contextlib.suppress(OSError):
        print(f"halation: {sentence}", file=sys.stderr, flush=True)
    if as_json:
        print_json({"error": {"kind": kind, "message": sentence, "exit_code": code}})
    return code


def _describe(fault: BaseException) -> tuple[str, int, str]:
    """Kind, exit code and sentence."""
    if isinstance(fault, HalationError):
        return type(fault).__name__, fault.exit_code, str(fault)
    if isinstance(fault, KeyboardInterrupt):
        return "Interrupted", INTERRUPTED, "interrupted; nothing unfinished was left behind"
    if isinstance(fault, OSError):  # one that concerns no file is of standard output
        return "OSError", 1, f"{fault.filename or 'standard output'}: the system refuses ({fault.strerror or fault})"
    if isinstance(fault, MemoryError):
        return "MemoryError", 1, "there is not enough memory: render smaller with --scale or --size"
    if format_message := getattr(fault, "format_message", None):  # what the parser of the command line raises
        context = getattr(fault, "ctx", None)
        command = context.command_path if context else "halation"
        text = str(format_message()).strip().rstrip(".")
        return "UsageError", USAGE, f"{text[:1].lower()}{text[1:]}; see {command} --help"
    text = " ".join(str(fault).split())
    return "Bug", BUG, f"this is a bug in Halation ({type(fault).__name__}: {text}); HALATION_DEBUG=1 shows where"


def flush_output(code: int) -> int:
    """Get the last output out; the exit code if that works, else another."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OSError as fault:
        return code or report_failure(fault, False)
    return code


def _close_output() -> None:
    """Send to nowhere what is still waiting to be written to standard output."""
    with contextlib.suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def print_json(item: object) -> None:
    """One JSON object on standard output."""
    print(json.dumps(item, indent=2, ensure_ascii=False, default=str))


def note(sentence: str) -> None:
    """Something a person may want to know, on standard error."""
    print(sentence, file=sys.stderr, flush=True)
