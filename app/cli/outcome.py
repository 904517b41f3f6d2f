"""How a command ends: one sentence on standard error or one JSON object, and the right exit code."""

from __future__ import annotations

import functools
import json
import os
import sys
from collections.abc import Callable
from typing import Any

import typer

from ..errors import HalationError

INTERRUPTED = 130
BROKEN_PIPE = 141
BUG = 70

EXIT_CODES = """\b
Exit codes:
0    done
1    rendering or writing failed; fmt --check found something to format
2    the command line makes no sense
3    the graph is at fault
4    a picture cannot be read
5    no usable OpenGL, a shader was refused, or the device is full
130  interrupted"""


def guarded(command: Callable[..., None]) -> Callable[..., None]:
    """Turn what a command raises into a sentence and an exit code; under `--json` into an object as well."""

    @functools.wraps(command)
    def run(*args: Any, **options: Any) -> None:
        try:
            command(*args, **options)
        except HalationError as fault:
            _fail(str(fault), fault.exit_code, type(fault).__name__, bool(options.get("as_json")))
        except KeyboardInterrupt:
            _fail("interrupted; nothing unfinished was left behind", INTERRUPTED, "Interrupted", False)
        except BrokenPipeError:
            # Whoever read our output has gone: that is no fault of ours, and nothing can be said to them.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(BROKEN_PIPE) from None
        except MemoryError:
            _fail("out of memory: render smaller with --scale or --size", 1, "MemoryError", False)
        except typer.Exit:
            raise
        except Exception as fault:
            if os.environ.get("HALATION_DEBUG"):
                raise
            _fail(
                f"this is a bug in Halation ({type(fault).__name__}: {fault}); set HALATION_DEBUG=1 for the details",
                BUG, "Bug", bool(options.get("as_json")),
            )

    return run


def _fail(sentence: str, code: int, kind: str, as_json: bool) -> None:
    print(f"halation: {sentence}", file=sys.stderr)
    if as_json:
        print_json({"error": {"kind": kind, "message": sentence, "exit_code": code}})
    raise typer.Exit(code)


def print_json(item: object) -> None:
    """One JSON object on standard output."""
    print(json.dumps(item, indent=2, ensure_ascii=False, default=str))


def note(sentence: str) -> None:
    """Something a person may want to know, on standard error."""
    print(sentence, file=sys.stderr, flush=True)
