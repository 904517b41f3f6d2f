"""`./dev release`: what is published of a version, into out/release, from the last commit.

The wheel, the source archive, NOTICE with the licenses of all that a full installation brings, bills of materials in
the form of CycloneDX, the application for Linux as an archive and as one file, and SHA256SUMS. The same commit gives
the same bytes, so that anybody can build a release again and compare. Four things would differ otherwise, and each is
fixed here: files come from the commit and not from the working folder, dates are that of the commit, rights do not
depend on the user's umask, and the members of archives have no owner. The wheel is built from the source archive.
Everything is built twice and compared.
"""

from __future__ import annotations

import gzip
import hashlib
import io
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from importlib.metadata import Distribution, distribution, distributions, version
from pathlib import Path

from application.build import SystemPart, build_folder, list_system_parts, pack_folder, write_single_file
from bill_of_materials import write_application_bill, write_environment_bill

ROOT = Path(__file__).parents[1]
DEVELOPMENT_EXTRAS = frozenset({"docs", "release", "test"})
"""Extras for work on Halation; a full installation has all others."""

_LICENSE_FILE = re.compile(r"(^|/)(licen[cs]es?/|(licen[cs]e|copying|notice|authors)[^/]*$)", re.I)
_LIBRARY = re.compile(r"^(?!.*\.(cpython|abi3)).*\.(so|dylib|dll)(\.|$)", re.I)
"""A library that is no Python module."""


def main() -> None:
    """Write all files of the release, or stop with a sentence that says what is wrong."""
    if read_output("git", "status", "--porcelain", "--untracked-files=no"):
        sys.exit("release: some files differ from the last commit; commit them first")
    commit_time = int(read_output("git", "log", "-1", "--format=%ct"))
    folder = ROOT / "out/release"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        trees = [export_commit(work / f"tree{turn}") for turn in (1, 2)]
        builds = [build_packages(tree, work / f"build{turn}", commit_time) for turn, tree in enumerate(trees)]
        for first, second in zip(*builds, strict=True):
            if first.read_bytes() != second.read_bytes():
                sys.exit(f"release: two builds of {first.name} differ; this is a fault of tests/release.py")
            shutil.copy(first, folder)
        python = install_everything(builds[0][1], work / "installation")
        (libraries,) = python.parents[1].glob("lib/python*/site-packages")
        notice = write_notice(distributions(path=[str(libraries)]))
        write_environment_bill(python, folder / "halation.cdx.json")
        if sys.platform == "linux":
            notice += write_application(builds[0][1], python, work, folder, commit_time)
        (folder / "NOTICE").write_text(notice, encoding="utf-8", newline="\n")
    (folder / "SHA256SUMS").write_text(write_checksums(folder), encoding="ascii", newline="\n")
    for path in sorted(folder.iterdir()):
        print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1e6:.2f} MB")


def write_application(wheel: Path, python: Path, work: Path, folder: Path, commit_time: int) -> str:
    """Build the application for Linux twice, as an archive and as one file; returns what is to be added to NOTICE.

    The second one is built from an installation in another folder: nothing may depend on where the first one was.
    """
    name = f"halation-{read_version()}-linux-{platform.machine()}"
    archives: list[Path] = []
    applications: list[Path] = []
    for turn, builder in enumerate((python, install_everything(wheel, work / "second_installation")), 1):
        pip = [sys.executable, "-m", "pip", "--python", builder, "install", "--quiet"]
        subprocess.run([*pip, f"pyinstaller=={version('pyinstaller')}"], check=True)
        (work / f"application{turn}").mkdir()
        applications.append(build_folder(builder, work / f"application{turn}", commit_time))
        archives.append(work / f"application{turn}" / f"{name}.tar.gz")
        pack_folder(applications[-1], archives[-1], commit_time)
    if archives[0].read_bytes() != archives[1].read_bytes():
        sys.exit("release: two builds of the application differ; this is a fault of tests/application/build.py")
    shutil.copy(archives[0], folder)
    write_single_file(archives[0], folder / f"{name}.run")
    parts = [*list_system_parts(applications[0]), describe_bootloader()]
    write_application_bill(folder / "halation.cdx.json", parts, folder / f"{name}.cdx.json")
    texts = [f"{'=' * 80}\n{part.name} {part.version}\n\n{part.notice}\n" for part in parts]
    return "\nThe application for Linux holds these too.\n" + "\n".join(texts)


def describe_bootloader() -> SystemPart:
    """The program of PyInstaller that starts the application."""
    package = distribution("pyinstaller")
    texts = "\n".join(read_license_texts(package))
    return SystemPart("pyinstaller", package.version, f"pkg:pypi/pyinstaller@{package.version}", texts)


def read_version() -> str:
    """The version of Halation."""
    return re.findall(r'^VERSION = "(.+)"', (ROOT / "app/version.py").read_text(encoding="utf-8"), re.M)[0]


def read_output(*words: str) -> str:
    """What a command prints in the root of the repository."""
    return subprocess.run(words, cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


def export_commit(tree: Path) -> Path:
    """Write the files of the last commit to a new folder; returns the folder."""
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as files:
        files.extractall(tree, filter="data")
    return tree


def build_packages(tree: Path, folder: Path, commit_time: int) -> tuple[Path, Path]:
    """Build the source archive from a tree and the wheel from the source archive; returns both."""
    run_build("--sdist", "--outdir", folder, tree, commit_time=commit_time)
    (archive,) = folder.glob("*.tar.gz")
    normalize_archive(archive, commit_time)
    with tarfile.open(archive) as files:
        files.extractall(folder / "source", filter="data")
    (source,) = (folder / "source").iterdir()
    run_build("--wheel", "--outdir", folder, source, commit_time=commit_time)
    (wheel,) = folder.glob("*.whl")
    return archive, wheel


def run_build(*words: str | Path, commit_time: int) -> None:
    """Run the tool `build` with the installed setuptools, so that no network is needed."""
    command = [sys.executable, "-m", "build", "--no-isolation", *words]
    environment = {**os.environ, "SOURCE_DATE_EPOCH": str(commit_time)}
    outcome = subprocess.run(command, env=environment, umask=0o022, capture_output=True, text=True)
    if outcome.returncode or "would be ignored" in outcome.stdout + outcome.stderr:
        sys.exit(f"release: building failed\n{outcome.stdout}{outcome.stderr}")


def normalize_archive(archive: Path, commit_time: int) -> None:
    """Rewrite a .tar.gz in place with members in order, without owners, with one date and the usual rights.

    setuptools writes the user, the umask and the time of the build into a source archive.
    """
    tar = io.BytesIO()
    with tarfile.open(archive) as old, tarfile.open(fileobj=tar, mode="w", format=tarfile.PAX_FORMAT) as new:
        for member in sorted(old.getmembers(), key=lambda member: member.name):
            clean = tarfile.TarInfo(member.name)
            clean.size, clean.type, clean.mtime = member.size, member.type, commit_time
            clean.mode = 0o755 if member.isdir() or member.mode & 0o100 else 0o644
            new.addfile(clean, old.extractfile(member))
    archive.write_bytes(gzip.compress(tar.getvalue(), mtime=commit_time))


def install_everything(wheel: Path, folder: Path) -> Path:
    """Install a wheel with all extras for users into a new environment without pip; returns its Python."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = sorted(project["optional-dependencies"].keys() - DEVELOPMENT_EXTRAS)
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    python = folder / "bin/python"
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--quiet"]
    subprocess.run([*pip, f"{wheel}[{','.join(extras)}]"], check=True)
    for origin in folder.glob("lib/python*/site-packages/halation-*/direct_url.json"):
        origin.unlink()  # names the temporary folder
    return python


def write_notice(packages: Iterable[Distribution]) -> str:
    """The text of NOTICE: each package with its version, its license and the texts of its licenses."""
    parts = ["A full installation of Halation brings these packages. Their licenses follow.\n"]
    for package in sorted(packages, key=lambda package: package.name.lower()):
        parts += ["=" * 80, f"{package.name} {package.version}", f"License: {read_license(package)}"]
        libraries = sorted({path.name for path in package.files or () if _LIBRARY.search(path.name)})
        if libraries:
            parts.append(f"Libraries inside: {', '.join(libraries)}")
        parts += ["", *read_license_texts(package)]
    return "\n".join(parts)


def read_license(package: Distribution) -> str:
    """The license that a package states, in a line."""
    fields = package.metadata
    classifiers = [line.rpartition(" :: ")[2] for line in fields.get_all("Classifier") or () if "License ::" in line]
    (expression,), (text,) = (fields.get_all(name) or ("",) for name in ("License-Expression", "License"))
    stated = expression or ", ".join(classifiers) or text or "not stated"
    return "see below" if "\n" in stated.strip() else stated.strip()


def read_license_texts(package: Distribution) -> Iterator[str]:
    """The texts of all licenses that a package brings, each below its path; those of libraries inside it too."""
    for path in sorted(package.files or (), key=str):
        if _LICENSE_FILE.search(str(path)) and path.suffix not in (".py", ".pyc") and not _LIBRARY.search(path.name):
            yield f"--- {path}\n"
            yield path.read_text(encoding="utf-8") if is_text(path.read_binary()) else "(not a text)"


def is_text(content: bytes) -> bool:
    """Whether a file is text in UTF-8."""
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def write_checksums(folder: Path) -> str:
    """The text of SHA256SUMS, as sha256sum writes and checks it."""
    files = sorted(path for path in folder.iterdir() if path.name != "SHA256SUMS")
    return "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files)


if __name__ == "__main__":
    main()
