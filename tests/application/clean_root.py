"""Tries the application for Linux as a new user would: in a small Debian without Python and without a network.

    .venv/bin/python tests/application/clean_root.py            # what `./dev release` wrote to out/release

It needs root, and mmdebstrap, bubblewrap, Xvfb, openbox and xdotool, which Debian and Ubuntu have as packages. Two
small systems are made in out/clean_root once, one of them without OpenGL. Each step is printed with what came of it,
and pictures of the windows are written there too. The exit code is 1 if a step fails.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from small_system import HOME, Array, Screen, SmallSystem, count_colors, wait_until

ROOT = Path(__file__).parents[2]
TOOLS = ("mmdebstrap", "bwrap", "Xvfb", "openbox", "xdotool")
PACKAGES = (
    *("bash", "zsh", "fish", "libx11-6", "libx11-xcb1", "fontconfig-config", "fonts-dejavu-core"),
    *("libglib2.0-bin", "shared-mime-info", "desktop-file-utils"),
)
"""What the desktop of a user has: shells, the libraries of X11, fonts, GIO, by which file managers open files, and the
types of files."""

OPENGL = ("libegl1", "libgl1", "libgl1-mesa-dri")
SIZE_LIMIT = 250_000_000
"""Bytes of the application as one file."""

START_LIMIT = 1.3
"""How many times longer than the installed program it may take to start."""

STARTS = 9
"""Starts of each program, in turn: their median is compared. Chosen by judgement."""

PRESET = "soft_bloom"
_COLORS = 10_000
"""The least colors of the editor as soon as it shows the picture of the preset; its panels have 3,000."""


class Trial:
    """What is tried, in order: each method is a step, whose docstring is its name; it returns what is to be noted."""

    def __init__(self, program: Path, system: SmallSystem, bare: SmallSystem, screen: Screen, pictures: Path) -> None:
        self._program, self._system, self._bare, self._screen = program, system, bare, screen
        self._pictures = pictures
        for home in (system.home, bare.home):
            shutil.rmtree(home, ignore_errors=True)
            home.mkdir(parents=True)
            (home / "halation").symlink_to(f"/media/{program.name}")

    def list_steps(self) -> list[Callable[[], str]]:
        """All steps."""
        return [
            self.check_size,
            self.check_system,
            self.unpack,
            self.examine,
            self.render,
            self.complete,
            self.enter_desktop,
            self.open_by_click,
            self.make_thumbnails,
            self.edit,
            self.say_what_is_missing,
            self.measure_start,
        ]

    def check_size(self) -> str:
        """One file of at most 250 MB, as its checksum says"""
        subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=self._program.parent, check=True)
        size = self._program.stat().st_size
        assert size <= SIZE_LIMIT, f"{size:,} bytes"
        return f"{size / 1e6:.1f} MB"

    def check_system(self) -> str:
        """The system has no Python and no network"""
        places = self._system.run("find", "/usr/bin", "/usr/lib", "-maxdepth", "1", "-name", "python*")
        assert not places, places
        networks = self._system.run("cat", "/proc/net/dev").splitlines()[2:]
        assert [line.split(":")[0].strip() for line in networks] == ["lo"], networks
        return self._system.run("cat", "/etc/debian_version").strip()

    def unpack(self) -> str:
        """The file runs, and is unpacked once"""
        started = time.perf_counter()
        version = self._system.run("halation", "--version").strip()
        first = time.perf_counter() - started
        started = time.perf_counter()
        assert self._system.run("halation", "--version").strip() == version
        return f"{version}; {first:.1f} s, then {time.perf_counter() - started:.2f} s"

    def examine(self) -> str:
        """halation doctor finds no fault, and names no folder of the user"""
        report = self._system.run("halation", "doctor")
        assert "fault" not in report and HOME not in report, report
        return next(line for line in report.splitlines() if " opengl " in line).split("opengl")[1].strip()

    def render(self) -> str:
        """A preset is rendered"""
        self._system.run("halation", "render", PRESET, "-o", "rendered.png")
        colors = count_colors(_read_picture(self._system.home / "rendered.png"))
        assert colors > 1000, f"{colors} colors"
        return f"{colors} colors"

    def complete(self) -> str:
        """bash, zsh and fish complete commands"""
        for shell in ("bash", "zsh", "fish"):
            answer = self._system.run(shell, "-c", "halation --show-completion; true")
            assert "_HALATION_COMPLETE" in answer, f"{shell}: {answer[-300:]}"
            (self._system.home / f"completion.{shell}").write_text(answer)
        bash = "source completion.bash; COMP_WORDS=(halation swe); COMP_CWORD=1; _halation_completion halation"
        zsh = "compdef() { :; }; source completion.zsh; words=(halation swe); CURRENT=2; "
        zsh += (
            "compadd() { print -l -- $@; }; _arguments() { print -l -- $@; }; _describe() { print -l -- ${(P)2} $@; }; "
        )
        answers = {
            "bash": self._system.run("bash", "-c", f"{bash}; echo ${{COMPREPLY[*]}}"),
            "zsh": self._system.run("zsh", "-c", f"{zsh}_halation_completion"),
            "fish": self._system.run("fish", "-c", "source completion.fish; complete --do-complete 'halation swe'"),
        }
        for shell, answer in answers.items():
            assert "sweep" in answer, f"{shell}: {answer[-300:]}"
        return ", ".join(answers)

    def enter_desktop(self) -> str:
        """halation desktop: graphs have a type, and Halation opens them and EXR files"""
        self._system.run("halation", "desktop")
        self._system.run("halation", "demo", "--copy", "demo")
        kind = self._system.run("gio", "info", "-a", "standard::content-type", f"demo/{PRESET}.json").split()[-1]
        assert kind == "application/x-halation-graph", kind
        for name in (kind, "image/x-exr"):
            assert "halation.desktop" in self._system.run("gio", "mime", name), name
        return kind

    def open_by_click(self) -> str:
        """A double-click on a graph, which GIO carries out, opens the editor"""
        words = ("sh", "-c", f"gio open demo/{PRESET}.json; sleep 600")
        with self._system.start(*words, display=self._screen.name):
            window = self._screen.wait_for_window(f"{PRESET}.*Halation$")
            self._take_picture("opened.png", _COLORS)
        self._screen.wait_for_no_window(window)
        return "opened.png"

    def make_thumbnails(self) -> str:
        """The entry for thumbnails makes those of a graph and of an EXR file"""
        entry = (self._system.home / ".local/share/thumbnailers/halation.thumbnailer").read_text()
        (command,) = re.findall("^Exec=(.*)$", entry, re.M)
        for file in (f"demo/{PRESET}.json", "demo/samples/neon.exr"):
            filled = command.replace("%i", file).replace("%o", "thumbnail.png").replace("%s", "128")
            self._system.run(*shlex.split(filled))
            picture = _read_picture(self._system.home / "thumbnail.png")
            assert max(picture.shape[:2]) == 128 and count_colors(picture) > 100, file
        return "128 pixels"

    def edit(self) -> str:
        """The editor opens a preset, and saves it; what was saved is rendered"""
        started = time.perf_counter()
        with self._system.start("halation", "edit", PRESET, display=self._screen.name) as process:
            self._screen.wait_for_window("Halation$")
            shown = time.perf_counter() - started
            self._take_picture("editor.png", _COLORS)
            self._screen.press("key", "ctrl+shift+s")
            time.sleep(2.0)
            self._screen.press("key", "ctrl+a")
            self._screen.press("type", "--delay", "30", f"{HOME}/saved.json")
            self._screen.press("key", "Return")
            graph = self._system.home / "saved.json"
            wait_until(graph.is_file, "nothing was saved")
            self._screen.press("key", "ctrl+q")
            wait_until(lambda: process.poll() is not None, "the editor was never closed")
            assert process.returncode == 0, process.returncode
        self._system.run("halation", "render", "saved.json", "-o", "saved.png")
        rendered, saved = (_read_picture(self._system.home / name) for name in ("rendered.png", "saved.png"))
        assert np.array_equal(rendered, saved)
        return f"window after {shown:.1f} s, editor.png; the same pixels"

    def say_what_is_missing(self) -> str:
        """Without OpenGL a window says so"""
        self._bare.run("halation", "desktop")
        entry = (self._bare.home / ".local/share/applications/halation.desktop").read_text()
        (command,) = re.findall("^Exec=(.*)$", entry, re.M)
        with self._bare.start(*shlex.split(command.replace("%f", "")), display=self._screen.name):
            self._screen.wait_for_window("^Halation$")
            self._take_picture("no_opengl.png", 20)
        return "no_opengl.png"

    def measure_start(self) -> str:
        """It starts nearly as fast as the installed program"""
        installed = shutil.which("halation", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
        if installed is None:
            return "no other one is installed"
        cache = self._system.home / ".cache"
        environment = {**os.environ, "XDG_CACHE_HOME": str(cache)}
        seconds: dict[str, list[float]] = {installed: [], str(self._program): []}
        for _ in range(STARTS):
            for program, times in seconds.items():
                started = time.perf_counter()
                subprocess.run([program, "nodes", "--json"], env=environment, capture_output=True, check=True)
                times.append(time.perf_counter() - started)
        own, packed = map(statistics.median, seconds.values())
        assert packed <= START_LIMIT * own, f"{packed:.2f} s, {packed / own:.2f} of {own:.2f} s"
        return f"{packed:.2f} s, {packed / own:.2f} of {own:.2f} s"

    def _take_picture(self, name: str, least_colors: int) -> Array:
        pixels = self._screen.wait_for_picture(least_colors)
        picture = oiio.ImageBuf(np.ascontiguousarray(pixels))
        assert picture.write(str(self._pictures / name)), picture.geterror()
        return pixels


def _read_picture(path: Path) -> Array:
    """The pixels of a picture as they are."""
    pixels = oiio.ImageBuf(str(path)).get_pixels(oiio.UINT8)
    assert pixels is not None, f"{path} is no picture"
    return pixels[..., :3]


def make_root(folder: Path, suite: str, *packages: str) -> Path:
    """A small Debian with these packages, made in a folder unless it is there."""
    if not folder.is_dir():
        made = folder.with_name(f"{folder.name}.part")
        shutil.rmtree(made, ignore_errors=True)
        # Debian's fish brings Python, for the pages of man alone. The user is one without rights.
        hook = (
            'rm -rf "$1"/usr/bin/python* "$1"/usr/lib/python*; echo "user:x:1000:1000::/home:/bin/sh" >>"$1"/etc/passwd'
        )
        words = ["mmdebstrap", "--quiet", "--variant=minbase", f"--include={','.join(packages)}"]
        words += [f"--customize-hook={hook}", suite, str(made)]
        subprocess.run(words, check=True)
        made.rename(folder)
    return folder


def main() -> None:
    """Print each step, and end with 1 if one of them failed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("release", nargs="?", type=Path, default=ROOT / "out/release", help="the folder of the release")
    parser.add_argument("--suite", default="trixie", help="of Debian, such as bookworm")
    parser.add_argument("--folder", type=Path, default=ROOT / "out/clean_root", help="where the systems are kept")
    arguments = parser.parse_args()
    if missing := [tool for tool in TOOLS if not shutil.which(tool)]:
        sys.exit(f"clean_root: install {', '.join(missing)} first")
    programs = sorted(arguments.release.resolve().glob("*.run"))
    if len(programs) != 1:
        sys.exit(f"clean_root: {arguments.release} has {len(programs)} applications: run ./dev release first")
    folder = arguments.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    systems: list[SmallSystem] = []
    for name, packages in (("desktop", (*PACKAGES, *OPENGL)), ("bare", PACKAGES)):
        root = make_root(folder / f"{arguments.suite}-{name}", arguments.suite, *packages)
        systems.append(SmallSystem(root, folder / f"home-{name}", programs[0].parent))
    failed = 0
    with ExitStack() as stack:
        trial = Trial(programs[0], systems[0], systems[1], Screen(folder, stack), folder)
        for step in trial.list_steps():
            name = (step.__doc__ or "").strip()
            try:
                print(f"ok     {name}: {step()}", flush=True)
            except (AssertionError, OSError, subprocess.SubprocessError) as fault:
                failed += 1
                print(f"FAULT  {name}: {fault}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
