"""`./dev release`: the same commit gives the same bytes, and every package is named with its license."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tarfile
import tomllib
import zipfile
from datetime import UTC, datetime
from importlib.metadata import distribution
from pathlib import Path

import pytest
from release import build_packages, normalize_archive, write_checksums, write_notice

ROOT = Path(__file__).parents[2]
COMMIT_TIME = 1_700_000_000
"""Seconds since 1970 of the commit that the tests pretend to release."""


@pytest.fixture
def small_project(tmp_path: Path) -> Path:
    """A project of two files with the build tool and the settings of Halation."""
    folder = tmp_path / "project"
    (folder / "app").mkdir(parents=True)
    (folder / "app/__init__.py").write_text('VERSION = "1.0"\n')
    (folder / "app/text.txt").write_text("text\n")
    settings = '[project]\nname = "halation"\nversion = "1.0"\n'
    settings += '[tool.setuptools]\npackages = ["halation"]\npackage-dir = {halation = "app"}\n'
    settings += '[tool.setuptools.package-data]\nhalation = ["*.txt"]\n'
    whole = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]
    build = f'[build-system]\nrequires = {whole["requires"]}\nbuild-backend = "{whole["build-backend"]}"\n'
    (folder / "pyproject.toml").write_text(build + settings)
    return folder


def test_a_second_build_has_the_same_bytes(small_project: Path, tmp_path: Path) -> None:
    """Another folder, umask, date and order of the files change nothing."""
    other = shutil.copytree(small_project, tmp_path / "elsewhere" / "copy")
    first = build_packages(small_project, tmp_path / "first", COMMIT_TIME)
    for path in sorted(other.rglob("*"), reverse=True):
        os.utime(path, (1_000_000_000, 1_000_000_000))
        path.chmod(0o700 if path.is_dir() else 0o600)
    umask = os.umask(0o077)
    try:
        second = build_packages(other, tmp_path / "second", COMMIT_TIME)
    finally:
        os.umask(umask)
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
    archive, wheel = first
    with tarfile.open(archive) as files:
        assert {(member.mtime, member.uid, member.uname) for member in files} == {(COMMIT_TIME, 0, "")}
    moment = datetime.fromtimestamp(COMMIT_TIME, UTC)
    with zipfile.ZipFile(wheel) as files:
        assert {member.date_time[:5] for member in files.infolist()} == {moment.timetuple()[:5]}


def test_an_archive_keeps_what_it_holds(tmp_path: Path) -> None:
    (tmp_path / "b.txt").write_bytes(b"two")
    (tmp_path / "a.sh").write_bytes(b"one")
    (tmp_path / "a.sh").chmod(0o700)
    with tarfile.open(tmp_path / "x.tar.gz", "w:gz") as files:
        for name in ("b.txt", "a.sh"):
            files.add(tmp_path / name, name)
    normalize_archive(tmp_path / "x.tar.gz", COMMIT_TIME)
    listing = subprocess.run(["tar", "tvzf", tmp_path / "x.tar.gz"], capture_output=True, text=True, check=True).stdout
    assert [(line.split()[0], line.split()[-1]) for line in listing.splitlines()] == [
        ("-rwxr-xr-x", "a.sh"),
        ("-rw-r--r--", "b.txt"),
    ]


def test_the_notice_has_every_package_with_its_license() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    names = [re.split(r"[><=]", line)[0] for line in project["dependencies"]]
    notice = write_notice(map(distribution, names))
    for name in names:
        part = notice.partition(f"\n{distribution(name).name} {distribution(name).version}\nLicense: ")[2]
        assert part and not part.startswith("not stated"), name
    assert "Redistribution and use in source and binary forms" in notice
    assert re.search(r"Libraries inside: .*openblas", notice)


def test_checksums_are_those_of_sha256sum(tmp_path: Path) -> None:
    (tmp_path / "b").write_bytes(b"two")
    (tmp_path / "a").write_bytes(b"one")
    (tmp_path / "SHA256SUMS").write_text(write_checksums(tmp_path))
    checked = subprocess.run(["sha256sum", "-c", "SHA256SUMS"], cwd=tmp_path, capture_output=True, text=True)
    assert checked.stdout == "a: OK\nb: OK\n"
