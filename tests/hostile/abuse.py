"""Broken environments: closed streams, missing folders, garbage in variables, few descriptors, little memory."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import kills
from cases import EXIT_CODES
from pool import Tally

Set = Callable[[], None]


def _limit(kind: int, amount: int) -> Set:
    return lambda: resource.setrlimit(kind, (amount, amount))


def _close(*descriptors: int) -> Set:
    def close() -> None:
        for descriptor in descriptors:
            os.close(descriptor)

    return close


VARIABLES: dict[str, dict[str, str | None]] = {
    "no HOME": {"HOME": None, "XDG_CACHE_HOME": None, "XDG_CONFIG_HOME": None},
    "HOME that is a file": {"HOME": "/dev/null", "XDG_CACHE_HOME": "/dev/null/x"},
    "no PATH": {"PATH": ""},
    "TMPDIR that is missing": {"TMPDIR": "/nothing/here"},
    "a language that is missing": {"LANG": "xx_XX.UTF-8", "LC_ALL": "xx_XX"},
    "the C locale": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    "OCIO that is missing": {"OCIO": "/nothing/config.ocio"},
    "OCIO that is garbage": {"OCIO": "\udcff"},
    "HALATION_MAX_PIXELS that is no number": {"HALATION_MAX_PIXELS": "many"},
    "HALATION_ROOT that is missing": {"HALATION_ROOT": "/nothing"},
    "COLUMNS that is no number": {"COLUMNS": "wide", "LINES": "-1"},
    "no rasterizer": {"LIBGL_DRIVERS_PATH": "/nothing", "GALLIUM_DRIVER": "nothing"},
    "a display that is missing": {"DISPLAY": ":99", "WAYLAND_DISPLAY": "nothing"},
}

LIMITS: dict[str, Set] = {
    "closed standard input": _close(0),
    "closed standard output": _close(1),
    "closed standard error": _close(2),
    "all streams closed": _close(0, 1, 2),
    "20 descriptors": _limit(resource.RLIMIT_NOFILE, 20),
    "600 MB of address space": _limit(resource.RLIMIT_AS, 600 << 20),
    "1500 MB of address space": _limit(resource.RLIMIT_AS, 1500 << 20),
    "300 MB of data": _limit(resource.RLIMIT_DATA, 300 << 20),
    "files of 100 bytes": _limit(resource.RLIMIT_FSIZE, 100),
    "no processes": _limit(resource.RLIMIT_NPROC, 1),
    "a deep stack": _limit(resource.RLIMIT_STACK, 1 << 20),
}

COMMANDS = (
    ("render", "graph.json", "-o", "new.exr"),
    ("check", "graph.json"),
    ("info", "out.exr", "--json"),
    ("nodes",),
    ("--help",),
)


def run_abuse(keep: Path | None) -> Tally:
    """Every command in every environment."""
    tally = Tally()
    for words in COMMANDS:
        for label, changes in VARIABLES.items():
            environment = {name: value for name, value in {**os.environ, **changes}.items() if value is not None}
            _try(tally, f"{words[0]} with {label}", words, environment, None)
        for label, limit in LIMITS.items():
            _try(tally, f"{words[0]} with {label}", words, dict(os.environ), limit)
        _try(tally, f"{words[0]} in a folder that is gone", words, dict(os.environ), None, gone=True)
    return tally


def _try(
    tally: Tally, name: str, words: tuple[str, ...], environment: dict[str, str], limit: Set | None, gone: bool = False
) -> None:
    with tempfile.TemporaryDirectory(prefix="hostile-abuse-") as text:
        folder = Path(text)
        kills.prepare(folder)

        def enter() -> None:
            if gone:
                os.chdir(folder)
                for path in folder.iterdir():
                    path.unlink()
                folder.rmdir()
            if limit:
                limit()

        command = [sys.executable, "-P", "-m", "halation.cli", *words]
        tally.count += 1
        try:
            result = subprocess.run(
                command, cwd=folder, env=environment, capture_output=True, timeout=60, preexec_fn=enter
            )
        except subprocess.TimeoutExpired:
            tally.faults.append((name, "hang"))
            return
        except (OSError, subprocess.SubprocessError):  # the interpreter itself could not be started
            return
        finally:
            if gone:
                folder.mkdir(exist_ok=True)
        said = (result.stdout + result.stderr).decode("utf-8", "replace")
        faults = [] if result.returncode in EXIT_CODES or _is_pythons_own(said) else [f"exit code {result.returncode}"]
        if "Traceback (most recent call last)" in said and not _is_pythons_own(said):
            faults.append("traceback")
        faults += kills.find_broken(folder) if not gone else []
        for fault in faults:
            tally.faults.append((name, fault))
            print(f"{name}: {fault}: {said.strip().splitlines()[-1][:160] if said.strip() else ''}", flush=True)


def _is_pythons_own(said: str) -> bool:
    """True if the interpreter or a library could not even be loaded, which is before anything of ours runs."""
    return "Fatal Python error" in said or "failed to map segment" in said or "cannot allocate memory in static" in said
