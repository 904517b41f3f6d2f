"""Unpacks a newer Mesa beside that of the system, for `drivers.py`: the packages of Debian's backports.

    .venv/bin/python tests/bench/newer_mesa.py

Nothing is installed, and root is not needed: apt keeps lists and packages of its own in out/drivers, from the mirror
that the system has anyway. On other systems it says so. Standard library alone.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from bench.driver_list import NEWER

PACKAGES = (
    "libegl-mesa0",
    "libglx-mesa0",
    "libgl1-mesa-dri",
    "mesa-libgallium",
    "mesa-vulkan-drivers",
    "libgbm1",
    "libdrm2",
    "libdrm-amdgpu1",
    "libdrm-intel1",
)
"""Mesa in parts, and what it needs newer than the system has it. The rest, such as LLVM, the older Mesa needs too."""

_KEYS = Path("/usr/share/keyrings/debian-archive-keyring.gpg")
_SECONDS = 600


class UnavailableError(Exception):
    """This system has no newer Mesa to unpack."""


def find_source(targets: str) -> str:
    """The line of apt's sources for backports, from `apt-get indextargets` in the format of `list_targets`.

    Raises UnavailableError for anything but a stable Debian.
    """
    for line in targets.splitlines():
        uri, release, component, label = line.split("|")
        if label == "Debian" and component == "main" and "-" not in release and release not in ("sid", "testing"):
            keys = f"[signed-by={_KEYS}] " if _KEYS.is_file() else ""
            return f"deb {keys}{uri} {release}-backports main\n"
    raise UnavailableError("only a stable Debian has backports")


def list_targets() -> str:
    """Where the packages of this system come from: address, release, component and label, a line each."""
    if not shutil.which("apt-get"):
        raise UnavailableError("this system has no apt")
    words = ["--format", "$(REPO_URI)|$(CODENAME)|$(COMPONENT)|$(LABEL)", "Created-By: Packages"]
    return _run(["apt-get", "indextargets", *words], Path.cwd())


def unpack(folder: Path) -> str:
    """Fetch the packages and unpack them into a folder that replaces what was there; the version.

    Raises UnavailableError where they cannot be had.
    """
    work = folder.parent / "apt"
    shutil.rmtree(work, ignore_errors=True)
    for part in ("lists/partial", "cache/archives/partial", "packages"):
        (work / part).mkdir(parents=True)
    (work / "backports.list").write_text(find_source(list_targets()), "utf-8")
    settings = {
        "Dir::State::lists": work / "lists",
        "Dir::Cache": work / "cache",
        "Dir::Etc::sourcelist": work / "backports.list",
        "Dir::Etc::sourceparts": "-",
        "APT::Sandbox::User": "",
    }
    options = [word for name, value in settings.items() for word in ("-o", f"{name}={value}")]
    _run(["apt-get", *options, "-q", "update"], work)
    release = (work / "backports.list").read_text("utf-8").split()[-2]
    _run(["apt-get", *options, "-q", "download", *(f"{name}/{release}" for name in PACKAGES)], work / "packages")
    fresh = work / "mesa"
    packages = sorted((work / "packages").glob("*.deb"))
    for package in packages:
        _run(["dpkg", "-x", str(package), str(fresh)], work)
    shutil.rmtree(folder, ignore_errors=True)
    fresh.replace(folder)
    shutil.rmtree(work, ignore_errors=True)
    return next((package.name.split("_")[1] for package in packages if package.name.startswith("libegl-mesa0")), "")


def _run(words: list[str], folder: Path) -> str:
    """What a command prints. Raises UnavailableError with its last line where it fails."""
    try:
        ended = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=_SECONDS)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise UnavailableError(f"{words[0]}: {error}") from error
    if ended.returncode:
        raise UnavailableError((ended.stderr.strip().splitlines() or [f"{words[0]} failed"])[-1])
    return ended.stdout


def main() -> int:
    """Unpack what is not there yet, and say which; 1 where there is none."""
    try:
        version = "an earlier one" if NEWER.is_dir() else unpack(NEWER)
    except UnavailableError as error:
        print(f"No newer Mesa: {error}", file=sys.stderr)
        return 1
    print(f"Mesa {version} in {NEWER}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
