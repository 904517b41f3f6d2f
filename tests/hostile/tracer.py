"""Runs a command and kills it as its n-th call that changes a file of a folder begins, whichever thread makes it.

    python tests/hostile/tracer.py FOLDER NUMBER all|one COMMAND...

Prints one JSON object: the exit code, the changes that were counted, and the call at which it was killed, if it was. 0
kills nothing. `one` kills the process that makes the call, `all` kills everything that the command started.

strace can kill at a call too, but counts the calls of each thread and each name alone, and threads share their work
differently in each run: nine of ten moments were missed. Here the kernel stops the command at each call that may change
files (seccomp), this process reads the path of the call, and counts those of the folder over all threads. Linux on
x86-64.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import platform
import signal
import struct
import sys
from pathlib import Path

BY_DESCRIPTOR = {
    "write": 1,
    "pwrite64": 18,
    "writev": 20,
    "pwritev": 296,
    "pwritev2": 328,
    "sendfile": 40,
    "ftruncate": 77,
    "fallocate": 285,
    "fsync": 74,
    "fdatasync": 75,
    "fchmod": 91,
}
BY_PATH = {"truncate": 76, "creat": 85, "rename": 82, "unlink": 87, "mkdir": 83, "rmdir": 84, "chmod": 90, "link": 86}
BY_FOLDER = {"renameat": 264, "renameat2": 316, "unlinkat": 263, "mkdirat": 258, "fchmodat": 268, "linkat": 265}
"""The numbers of calls whose first argument is a descriptor, a path, or a folder's descriptor before a path."""

OPENING = {"open": 2, "openat": 257}
COPYING = {"copy_file_range": 326}

NAMES = {
    number: name for calls in (BY_DESCRIPTOR, BY_PATH, BY_FOLDER, OPENING, COPYING) for name, number in calls.items()
}
CHANGING = os.O_CREAT | os.O_TRUNC

TRACEME, CONT, SETOPTIONS, GET_SYSCALL_INFO = 0, 7, 0x4200, 0x420E
EVENTS = 0x02 | 0x04 | 0x08 | 0x10 | 0x80 | 0x100000
"""Forks, vforks, clones, execs and filtered calls stop; what is traced dies with this process."""

SECCOMP_STOP = signal.SIGTRAP | 7 << 8
AT_CWD = 0xFFFFFF9C
ANY_CHILD, WAIT_FOR_THREADS = -1, 0x40000000
PATIENCE = 120
"""Seconds after which a command hangs."""

_LIBC = ctypes.CDLL(None, use_errno=True)
_LIBC.ptrace.argtypes = (ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p)


def _ptrace(request: int, thread: int, address: int = 0, argument: object = 0) -> None:
    if _LIBC.ptrace(request, thread, address, argument) < 0:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()))


def _install_filter() -> None:
    """Stop at the calls that may change files, and only there: a start of Python makes thousands of others."""
    instructions = [struct.pack("HBBI", 0x20, 0, 0, 0)]  # load the number of the call
    for place, number in enumerate(NAMES):
        instructions.append(struct.pack("HBBI", 0x15, len(NAMES) - place, 0, number))
    instructions += [struct.pack("HBBI", 0x06, 0, 0, verdict) for verdict in (0x7FFF0000, 0x7FF00000)]
    code = ctypes.create_string_buffer(b"".join(instructions))
    program = ctypes.create_string_buffer(struct.pack("HxxxxxxP", len(instructions), ctypes.addressof(code)))
    if _LIBC.prctl(38, 1, 0, 0, 0) or _LIBC.prctl(22, 2, program, 0, 0):
        raise OSError(ctypes.get_errno(), "calls cannot be filtered here")


def _start(command: list[str]) -> int:
    process = os.fork()
    if not process:
        os.setsid()
        _ptrace(TRACEME, 0)
        os.kill(os.getpid(), signal.SIGSTOP)
        _install_filter()
        os.execv(command[0], command)
    os.waitpid(process, 0)
    _ptrace(SETOPTIONS, process, 0, EVENTS)
    return process


def _read_call(thread: int) -> tuple[str, tuple[int, ...]]:
    """The name and the arguments of the call at which a thread stands."""
    record = ctypes.create_string_buffer(128)
    _ptrace(GET_SYSCALL_INFO, thread, len(record), record)
    number, *arguments = struct.unpack_from("7Q", record.raw, 24)
    return NAMES[number], tuple(arguments)


def _read_text(thread: int, address: int) -> str:
    with open(f"/proc/{thread}/mem", "rb", buffering=0) as memory:  # noqa: PTH123 - not a file
        memory.seek(address)
        return os.fsdecode(memory.read(4096).partition(b"\0")[0])


def _find_path(thread: int, name: str, arguments: tuple[int, ...]) -> str:
    """What a call would change; "" if it changes nothing."""
    if name in BY_DESCRIPTOR or name in COPYING:
        descriptor = arguments[2 if name in COPYING else 0] & 0xFFFFFFFF
        return str(Path(f"/proc/{thread}/fd/{descriptor}").readlink())
    has_folder = name in BY_FOLDER or name == "openat"
    if name in OPENING and not arguments[2 if has_folder else 1] & CHANGING:
        return ""
    path = _read_text(thread, arguments[1 if has_folder else 0])
    folder = arguments[0] & 0xFFFFFFFF if has_folder else AT_CWD
    base = f"/proc/{thread}/cwd" if folder == AT_CWD else f"/proc/{thread}/fd/{folder}"
    return os.path.join(Path(base).readlink(), path)  # noqa: PTH118 - the path may be absolute


def _kill(thread: int, process: int, everything: bool) -> None:
    if everything:
        os.killpg(process, signal.SIGKILL)
        return
    status = Path(f"/proc/{thread}/status").read_text()
    os.kill(int(status.partition("Tgid:")[2].split()[0]), signal.SIGKILL)


def trace(folder: str, moment: int, everything: bool, command: list[str]) -> dict[str, object]:
    """Run a command to its end, or to the call of that number."""
    process, changes, place, code = _start(command), 0, "", 0
    thread, status = process, signal.SIGSTOP << 8 | 0x7F
    while True:
        passed = 0
        if os.WIFSTOPPED(status):
            if status >> 8 == SECCOMP_STOP:
                with contextlib.suppress(OSError):  # it was killed meanwhile, or has closed what it names
                    name, arguments = _read_call(thread)
                    if _find_path(thread, name, arguments).startswith(folder + "/"):
                        changes += 1
                        if changes == moment:
                            place = f"{name} {Path(_find_path(thread, name, arguments)).name}"
                            _kill(thread, process, everything)
            elif status >> 16 == 0 and os.WSTOPSIG(status) not in (signal.SIGTRAP, signal.SIGSTOP):
                passed = os.WSTOPSIG(status)
            with contextlib.suppress(OSError):
                _ptrace(CONT, thread, 0, passed)
        elif thread == process:
            code = os.waitstatus_to_exitcode(status)
        try:
            thread, status = os.waitpid(ANY_CHILD, WAIT_FOR_THREADS)
        except ChildProcessError:
            return {"code": code, "changes": changes, "killed": place}


def main() -> None:
    """Trace the command of the command line."""
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        raise SystemExit("kills need Linux on x86-64")
    folder, moment, which, *command = sys.argv[1:]
    signal.alarm(PATIENCE)
    print(json.dumps(trace(os.path.realpath(folder), int(moment), which == "all", command)))


if __name__ == "__main__":
    main()
