"""What this machine has: processors, memory and a display."""

from __future__ import annotations

import math
import os
import re
import sys
from pathlib import Path

_CONTROL_GROUP = Path("/sys/fs/cgroup")
"""Where Linux says how much a container may take (cgroup v2, kernel documentation, "Control Group v2")."""


def available_cores() -> int:
    """Count the processors that this process may use: those it may run on, or whose time its container may take."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    quota, _, period = _read_line(_CONTROL_GROUP / "cpu.max").partition(" ")
    if quota.isdigit() and period.isdigit() and int(period):
        cores = min(cores, max(1, math.ceil(int(quota) / int(period))))
    return cores


def available_memory() -> float:
    """Bytes that programs can still get on this machine or in this container; infinite where nobody says."""
    try:
        text = Path("/proc/meminfo").read_text("ascii")
    except OSError:
        return math.inf
    free = re.search(r"^MemAvailable:\s*(\d+) kB", text, re.MULTILINE)
    available = int(free[1]) * 1024.0 if free else math.inf
    limit, used = (_read_line(_CONTROL_GROUP / f"memory.{name}") for name in ("max", "current"))
    return min(available, float(int(limit) - int(used))) if limit.isdigit() and used.isdigit() else available


def _read_line(path: Path) -> str:
    """The only line of a file of the system; "" where there is none."""
    try:
        return path.read_text("ascii").strip()
    except (OSError, ValueError):
        return ""


def has_display() -> bool:
    """True if windows can be opened: on Linux and the like, if a display is named."""
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def machine_memory() -> float:
    """Bytes of memory that this machine has; infinite where the system does not say."""
    if not hasattr(os, "sysconf"):
        return math.inf
    size = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return size if size > 0 else math.inf


def memory_limit() -> float:
    """Bytes of address space that this process may have (`ulimit -v`); infinite without a limit."""
    try:
        import resource
    except ImportError:  # Windows
        return math.inf
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return math.inf if limit == resource.RLIM_INFINITY else limit


def has_memory_limit() -> bool:
    """True if this process may have less address space than it asks for (`ulimit -v`)."""
    return memory_limit() < math.inf


_SCARCE = 0.75
"""The part of the limit that is near it: libraries ask for 64 to 256 MiB at a time (arenas of malloc, code of LLVM)."""


def is_memory_scarce() -> bool:
    """True if this process came near its limit of address space, so that requests for more may have been refused."""
    try:
        peak = re.search(r"VmPeak:\s*(\d+)", Path("/proc/self/status").read_text("ascii"))
    except OSError:
        return False
    return peak is not None and int(peak[1]) * 1024 > _SCARCE * memory_limit()


def resident_memory(process: int) -> int:
    """Bytes of memory that a process takes; 0 where the system does not say."""
    try:
        return int(Path(f"/proc/{process}/statm").read_text("ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):
        return 0


def describe_processor() -> str:
    """The model and the abilities of the processor, of which machine code depends; "" where the system does not say."""
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8", errors="replace") as file:
            text = file.read(8192)  # the first processor: others are like it, and a large machine has hundreds
    except OSError:
        return ""
    lines = re.findall(r"^(?:model name|flags|Features|CPU part)\s*:\s*(.*)$", text.partition("\n\n")[0], re.MULTILINE)
    return "\n".join(lines)


def suggest_driver() -> str:
    """What a user does where OpenGL cannot be opened, as the end of a sentence."""
    if sys.platform.startswith("linux"):
        return "install a graphics driver or the software rasterizer (Debian, Ubuntu: apt-get install libegl1 libgl1)"
    if sys.platform == "win32":
        return "install the graphics driver of your card's maker"
    return "run where a window system is available"


def count_busy_threads(ending: str) -> int:
    """Count the threads of this process whose names end so, and that run or wait for a disk; 0 where nobody says."""
    busy = 0
    for folder in Path("/proc/self/task").glob("*"):
        try:
            state = (folder / "stat").read_text("ascii", errors="replace")
        except OSError:  # it has ended
            continue
        name, _, rest = state.partition("(")[2].rpartition(")")
        busy += name.endswith(ending) and rest.split()[0] in "RD"
    return busy
