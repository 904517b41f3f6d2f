"""How commands end: the exit code and the sentence of each kind of failure, without a process for each."""

from __future__ import annotations

import errno
import io
import json
import sys
from contextlib import suppress
from typing import Any

import click
import numpy as np
import pytest
from halation.cli import outcome
from halation.cli.outcome import catch_faults, describe_fault, flush_output, print_note, report_failure, write_count
from halation.errors import DeviceError, DocumentError, HalationError, InputError, OutputError, UsageError
from halation.nodes import NodeImportError


@pytest.fixture(autouse=True)
def rich(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine with enough memory, and nobody who looks for faults."""
    monkeypatch.setattr(outcome, "is_memory_scarce", lambda: False)
    monkeypatch.delenv("HALATION_DEBUG", raising=False)


def make_click_fault(words: str, command: str) -> click.UsageError:
    parent = click.Context(click.Command("halation"), info_name="halation")
    context = click.Context(click.Command(command), info_name=command, parent=parent)
    return click.UsageError(words, context)


NO_FILE = OSError(errno.ENOSPC, "No space left on device")
A_FILE = OSError(errno.EACCES, "Permission denied", "a.json")
CLOSED = OSError(errno.EBADF, "Bad file descriptor")
CLOSED_FILE = OSError(errno.EBADF, "Bad file descriptor", "a.json")


@pytest.mark.parametrize(
    ("fault", "kind", "code", "words"),
    [
        (UsageError("no such node"), "UsageError", 2, "no such node"),
        (DocumentError("a.json", "", "it is empty", rule="unreadable-graph"), "DocumentError", 3, "it is empty"),
        (InputError("a.png: it is damaged"), "InputError", 4, "a.png: it is damaged"),
        (DeviceError("no device"), "DeviceError", 5, "no device"), (OutputError("disk"), "OutputError", 1, "disk"),
        (KeyboardInterrupt(), "Interrupted", 130, "interrupted; no unfinished file is left"),
        (CLOSED, "OSError", 1, "standard output is closed: the result cannot be printed"),
        (CLOSED_FILE, "OSError", 1, "a.json: the system reports an error: Bad file descriptor"),
        (NO_FILE, "OSError", 1, "standard output: the system reports an error: No space left on device"),
        (A_FILE, "OSError", 1, "a.json: the system reports an error: Permission denied"),
        (MemoryError(), "MemoryError", 1, "there is not enough memory; render a smaller picture with --scale"),
        (MemoryError("the history is too long"), "MemoryError", 1, "the history is too long"),
        (RuntimeError("can't start new thread"), "MemoryError", 1, "the system gives no more threads or memory"),
        (InputError("a.exr: EXR_ERR_OUT_OF_MEMORY"), "MemoryError", 1, "the system gives no more threads or memory"),
        (NodeImportError("a.py: no module"), "NodeImportError", 1, "a.py: no module"),
        (ImportError("no module"), "Bug", 70, "this is a bug in Halation (ImportError: no module); HALATION_DEBUG=1"),
        (ValueError("two\n  lines"), "Bug", 70, "this is a bug in Halation (ValueError: two lines)"),
    ],
)  # fmt: skip
def test_each_failure_has_a_code_and_a_sentence(fault: BaseException, kind: str, code: int, words: str) -> None:
    told = describe_fault(fault)
    assert (told["kind"], told["exit_code"]) == (kind, code) and words in told["message"]


def test_numpy_s_error_of_memory_says_what_helps() -> None:
    with pytest.raises(MemoryError) as caught:
        np.empty(1 << 56, np.float64)
    assert type(caught.value) is not MemoryError
    assert describe_fault(caught.value)["message"].startswith("there is not enough memory; render a smaller picture")


def test_where_memory_is_scarce_anything_is_its_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(outcome, "is_memory_scarce", lambda: True)
    told = describe_fault(SyntaxError("odd"))
    assert told["exit_code"] == 1 and told["message"].startswith("there is not enough memory (SyntaxError)")


@pytest.mark.parametrize(
    ("words", "command", "sentence"),
    [
        ("No such option.", "render", "no such option; see halation render --help"),
        ("Got unexpected extra argument (a.png)", "render",
         "got unexpected extra argument (a.png); pictures are bound with -i NAME=FILE; see halation render --help"),
        ("Got unexpected extra argument (a.png)", "info",
         "got unexpected extra argument (a.png); see halation info --help"),
    ],
)  # fmt: skip
def test_the_parser_s_errors_name_the_command(words: str, command: str, sentence: str) -> None:
    assert describe_fault(make_click_fault(words, command)) == {
        "kind": "UsageError", "message": sentence, "exit_code": 2,
    }  # fmt: skip
    alone = describe_fault(click.UsageError("No such option."))
    assert alone["message"] == "no such option; see halation --help"


def test_of_a_picture_its_reader_is_named_once() -> None:
    named, known = InputError("a.png: damaged"), InputError("input 'beauty': a.png: damaged")
    named.node = known.node = "inputs.beauty"
    told = describe_fault(named)["message"]
    assert told.endswith(": a.png: damaged") and "beauty" in told
    assert describe_fault(known)["message"] == "input 'beauty': a.png: damaged"
    other = HalationError("it is odd")
    other.node = "blur"
    assert describe_fault(other)["message"] == "it is odd"


def run(fault: BaseException | None, **options: Any) -> int:
    @catch_faults
    def command(**options: Any) -> int:
        if fault is not None:
            raise fault
        return 7

    return command(**options)


def test_a_command_ends_with_the_code_of_its_failure(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(None) == 7 and run(UsageError("so")) == 2
    assert capfd.readouterr() == ("", "halation: so\n")
    assert run(UsageError("so"), as_json=True) == 2
    out, err = capfd.readouterr()
    assert (
        json.loads(out) == {"error": {"kind": "UsageError", "message": "so", "exit_code": 2}}
        and err == "halation: so\n"
    )


def test_who_looks_for_bugs_gets_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HALATION_DEBUG", "1")
    assert report_failure(UsageError("so"), False) == 2
    with pytest.raises(ValueError, match="odd"):
        report_failure(ValueError("odd"), False)


@pytest.mark.parametrize(("code", "ended"), [(0, 141), (3, 3)])
def test_a_reader_that_has_gone_is_no_failure_of_ours(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], code: int, ended: int
) -> None:
    closed: list[bool] = []
    monkeypatch.setattr(outcome, "_close_output", lambda: closed.append(True))

    def fail() -> None:
        raise BrokenPipeError(errno.EPIPE, "Broken pipe")

    monkeypatch.setattr("sys.stdout.flush", fail)
    assert flush_output(code) == ended and closed == [True] * (code == 0)
    monkeypatch.undo()
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(("fault", "is_closed"), [(NO_FILE, True), (A_FILE, False)])
def test_output_that_is_lost_is_not_written_again(
    monkeypatch: pytest.MonkeyPatch, fault: OSError, is_closed: bool
) -> None:
    closed: list[bool] = []
    monkeypatch.setattr(outcome, "_close_output", lambda: closed.append(True))
    assert report_failure(fault, False) == 1 and bool(closed) is is_closed


def test_counts_have_their_noun() -> None:
    assert [write_count(count, "pass", "passes") for count in (0, 1, 2)] == ["0 passes", "1 pass", "2 passes"]
    assert [write_count(count, "file") for count in (1, 2)] == ["1 file", "2 files"]


@pytest.mark.parametrize("place", range(3))
def test_an_interrupt_between_two_writes_leaves_whole_lines(monkeypatch: pytest.MonkeyPatch, place: int) -> None:
    """A process that is ended says so on a line of its own, which whoever started it knows by its beginning."""

    class Stream(io.StringIO):
        """Standard error whose process is interrupted behind a write."""

        left = place

        def write(self, text: str) -> int:
            count, self.left = super().write(text), self.left - 1
            if self.left == -1:
                raise KeyboardInterrupt
            return count

    stream = Stream()
    monkeypatch.setattr(sys, "stderr", stream)
    with suppress(KeyboardInterrupt):
        for sentence in ("first", "second", "third"):
            print_note(sentence)
    report_failure(KeyboardInterrupt(), as_json=False)
    *lines, last = stream.getvalue().splitlines()
    assert lines == ["first", "second", "third"][: len(lines)] and last.startswith("halation: ")
