"""Builds the application for Linux: a folder that needs no Python, and one file that unpacks it.

PyInstaller collects the interpreter, the packages and their libraries. Of these some are taken out again: libraries
that every desktop has, because the driver of OpenGL may need newer ones than this machine has (those that AppImage's
list of exclusions names); and the parts of Open Image Denoise for graphics cards, because Halation denoises on the
processor.
"""

from __future__ import annotations

import gzip
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
from collections.abc import Mapping
from fnmatch import fnmatch
from pathlib import Path
from typing import IO, NamedTuple, cast
from urllib.parse import quote

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
_WHOLE_PACKAGES = (
    "imgui_bundle",
    "OpenImageIO",
    "PyOpenColorIO",
    "pyoidn",
    "dask",
    "distributed",
    "trimesh",
    "shellingham",
)
"""Packages whose data or lazily imported modules PyInstaller does not find by itself."""

_NOT_USED = ("pip", "setuptools", "pkg_resources", "PyInstaller")

_OF_THE_SYSTEM = tuple(
    f"lib{name}.so.*" for name in ("stdc++", "gcc_s", "X11", "X11-xcb", "xcb", "Xau", "Xdmcp", "GL", "GLX", "EGL")
)
"""Libraries at the top of the folder. Copies inside packages have names of their own and stay."""

_OF_GRAPHICS_CARDS = ("*_device_cuda*", "*_device_hip*", "*_device_sycl*", "libur_*", "libsycl*", "libtbbbind*")

_LIBRARY_FOLDERS = ("/lib/x86_64-linux-gnu", "/usr/lib/x86_64-linux-gnu")


def build_folder(python: Path, folder: Path, commit_time: int) -> Path:
    """Make the application in `folder` from an environment that has Halation and PyInstaller; returns its folder."""
    options = list_options(folder)
    environment = {**os.environ, "PYTHONHASHSEED": "1", "SOURCE_DATE_EPOCH": str(commit_time)}
    environment.pop("PYTHONPATH", None)
    command = [python, "-m", "PyInstaller", *options, HERE / "program.py"]
    outcome = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if outcome.returncode:
        sys.exit(f"release: building the application failed\n{outcome.stdout}{outcome.stderr}")
    application = folder / "halation"
    compile_modules(python, application / "lib", environment)
    remove_libraries(application / "lib")
    remove_traces(application / "lib")
    link_copies(application)
    return application


def list_options(folder: Path) -> list[str]:
    """The options of PyInstaller for an application in `folder`, on each system."""
    options = ["--noconfirm", "--log-level", "ERROR", "--name", "halation", "--contents-directory", "lib"]
    options += ["--distpath", str(folder), "--workpath", str(folder / "work"), "--specpath", str(folder / "work")]
    options += ["--additional-hooks-dir", str(HERE / "hooks")]
    options += [word for package in _WHOLE_PACKAGES for word in ("--collect-all", package)]
    options += [word for package in _NOT_USED for word in ("--exclude-module", package)]
    return options


def compile_modules(python: Path, libraries: Path, environment: Mapping[str, str]) -> None:
    """Compile the modules that stay files, without dates: the program of the folder keeps nothing that it compiles."""
    options = ("-q", "--invalidation-mode", "unchecked-hash", "-s", libraries, "-p", "lib")
    subprocess.run([python, "-m", "compileall", *options, libraries / "halation"], env=environment, check=True)


class SystemPart(NamedTuple):
    """What an application holds that is no Python package: its place in a bill of materials, and its license."""

    name: str
    version: str
    purl: str
    notice: str
    license: str = ""
    """An identifier of SPDX, where there is one for all of it."""


def list_system_parts(application: Path) -> list[SystemPart]:
    """What comes from this machine: Python, and the libraries that are no package's.

    Debian's system says to which of its packages a library belongs, and keeps the text of each license.
    """
    number = platform.python_version()
    text = read_text(Path(sysconfig.get_path("stdlib"), "LICENSE.txt"))
    parts = {"Python": SystemPart("Python", number, f"pkg:generic/python@{number}", text, "Python-2.0")}
    for path in sorted((application / "lib").glob("*.so*")):
        places = [Path(folder, path.name) for folder in _LIBRARY_FOLDERS]
        outcome = subprocess.run(["dpkg-query", "-S", *places], capture_output=True, text=True)
        if owner := re.match(r"[^:,\s]+", outcome.stdout):
            parts[owner[0]] = describe_debian_package(owner[0])
    return list(parts.values())


def describe_debian_package(name: str) -> SystemPart:
    """A package of the Debian or Ubuntu that this machine runs."""
    query = ["dpkg-query", "-W", "--showformat", "${Version} ${Architecture}\\n", name]
    version, architecture = subprocess.run(query, capture_output=True, text=True, check=True).stdout.split()[:2]
    system = platform.freedesktop_os_release()["ID"]
    purl = f"pkg:deb/{system}/{quote(name)}@{quote(version)}?arch={architecture}"
    return SystemPart(name, version, purl, read_text(Path("/usr/share/doc", name, "copyright")))


def read_text(path: Path) -> str:
    """The text of a file, or nothing where there is none."""
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def remove_libraries(libraries: Path) -> None:
    """Take out the libraries that the system has, and those that nothing uses."""
    for path in sorted(libraries.rglob("*")):
        patterns = _OF_THE_SYSTEM if path.parent == libraries else _OF_GRAPHICS_CARDS if "oidn" in path.parts else ()
        if any(fnmatch(path.name, pattern) for pattern in patterns):
            path.unlink()
    for path in libraries.iterdir():
        if path.is_symlink() and not path.exists():
            path.unlink()


def remove_traces(libraries: Path) -> None:
    """Take out what depends on the folder of the installation that was collected.

    Lists of installed files have the sums of scripts, whose first line names the Python of that folder, and pip
    compiles a list of authors that lies among licenses.
    """
    for path in [*libraries.glob("*.dist-info/RECORD"), *libraries.glob("*.dist-info/**/*.pyc")]:
        path.unlink()


def link_copies(folder: Path) -> None:
    """Put a link in the place of each library that lies beside a copy of itself: wheels can hold no links."""
    originals: dict[tuple[Path, str], Path] = {}
    for path in sorted(folder.rglob("*.so*"), key=lambda path: (-len(path.name), path)):
        if path.is_symlink() or not path.is_file():
            continue
        original = originals.setdefault((path.parent, hashlib.sha256(path.read_bytes()).hexdigest()), path)
        if original != path:
            path.unlink()
            path.symlink_to(original.name)


def pack_folder(application: Path, archive: Path, commit_time: int) -> None:
    """Write a .tar.gz of a folder: with members in order, without owners, with one date and the usual rights."""
    with (
        archive.open("wb") as file,
        gzip.GzipFile("", "wb", 6, file, mtime=commit_time) as packed,
        tarfile.open(fileobj=cast("IO[bytes]", packed), mode="w", format=tarfile.PAX_FORMAT) as tar,
    ):
        for path in sorted(application.rglob("*")):
            member = tar.gettarinfo(path, path.relative_to(application).as_posix())
            member.uid = member.gid = 0
            member.uname = member.gname = ""
            member.mtime = commit_time
            member.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            if member.isreg():
                with path.open("rb") as content:
                    tar.addfile(member, content)
            else:
                tar.addfile(member)


def write_single_file(archive: Path, target: Path) -> None:
    """Write one file that runs: it unpacks the archive of an application once, and starts it."""
    with archive.open("rb") as content:
        name = hashlib.file_digest(content, "sha256").hexdigest()[:16]
    script = (HERE / "single_file.sh").read_text(encoding="utf-8")
    script = script.replace("@NAME@", name).replace("@LINES@", str(script.count("\n") + 1))
    with target.open("wb") as file, archive.open("rb") as content:
        file.write(script.encode())
        shutil.copyfileobj(content, file)
    target.chmod(0o755)
