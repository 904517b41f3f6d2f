"""The application in one file: it unpacks itself once, whole or not at all, and removes what nobody runs any more."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest
from application.build import link_copies, pack_folder, remove_libraries, remove_traces, write_single_file

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux keeps to it")

COMMIT_TIME = 1_700_000_000


def write_program(folder: Path, version: str) -> Path:
    """A single file whose program tells its version, its arguments and the path that it was started by."""
    application = folder / f"application {version}"
    (application / "lib").mkdir(parents=True)
    program = application / "halation"
    program.write_text(f'#!/bin/sh\nprintf "%s|" {version} "$HALATION_PROGRAM" "$@"\n[ "$1" != wait ] || read line\n')
    program.chmod(0o755)
    (application / "lib/data").write_bytes(os.urandom(1 << 16))
    pack_folder(application, folder / f"{version}.tar.gz", COMMIT_TIME)
    single = folder / f"halation {version}.run"
    write_single_file(folder / f"{version}.tar.gz", single)
    return single


def call(single: Path, home: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "XDG_CACHE_HOME": str(home)}
    return subprocess.run([single, *words], env=environment, capture_output=True, text=True)


def list_places(home: Path) -> list[Path]:
    return sorted((home / "halation/application").iterdir())


def test_it_unpacks_once_and_passes_words_on(tmp_path):
    single = write_program(tmp_path, "1")
    for _ in range(2):
        outcome = call(single, tmp_path / "home", "render", "a b", "$c")
        assert (outcome.stdout, outcome.stderr) == (f"1|{single}|render|a b|$c|", "")
        (place,) = list_places(tmp_path / "home")
        os.utime(place / "lib/data", (1, 1))
    assert (place / "lib/data").stat().st_mtime == 1  # it was not unpacked again


def test_starts_side_by_side_give_one_folder(tmp_path):
    single, environment = write_program(tmp_path, "1"), {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "home")}
    processes = [subprocess.Popen([single, "x"], env=environment, stdout=subprocess.PIPE, text=True) for _ in range(6)]
    assert {process.communicate()[0] for process in processes} == {f"1|{single}|x|"}
    assert len(list_places(tmp_path / "home")) == 1


def test_another_version_takes_the_place_of_one_that_does_not_run(tmp_path):
    first, second, third = (write_program(tmp_path, version) for version in "123")
    home = tmp_path / "home"
    environment = {**os.environ, "XDG_CACHE_HOME": str(home)}
    call(first, home)
    with subprocess.Popen([second, "wait"], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as running:
        assert running.stdout is not None and running.stdout.read(2) == b"2|"
        assert len(list_places(home)) == 1  # the first is gone
        call(third, home)
        assert len(list_places(home)) == 2  # the second runs
        running.communicate(b"\n")
    call(first, home)
    assert len(list_places(home)) == 1


def test_a_damaged_file_leaves_nothing(tmp_path):
    single, home = write_program(tmp_path, "1"), tmp_path / "home"
    single.write_bytes(single.read_bytes()[:-20000])
    outcome = call(single, home)
    assert outcome.returncode == 1 and "unpacking failed" in outcome.stderr and not list_places(home)


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    home = tmp_path / "home"
    home.write_text("a file")
    outcome = call(write_program(tmp_path, "1"), home)
    assert outcome.returncode == 1 and f"{home}/halation/application: the folder cannot be made" in outcome.stderr


def test_an_archive_of_the_application_has_the_same_bytes(tmp_path):
    """Whatever the order, owners and dates of its files."""
    for folder, names in (("one", "ab"), ("two", "ba")):
        (tmp_path / folder).mkdir()
        for name in names:
            (tmp_path / folder / name).write_text(name)
        (tmp_path / folder / "link").symlink_to("a")
        os.utime(tmp_path / folder / "a", (len(folder + names), 5 if folder == "one" else 6))
        pack_folder(tmp_path / folder, tmp_path / f"{folder}.tar.gz", COMMIT_TIME)
    assert (tmp_path / "one.tar.gz").read_bytes() == (tmp_path / "two.tar.gz").read_bytes()
    with tarfile.open(tmp_path / "one.tar.gz") as tar:
        assert [(member.name, member.linkname) for member in tar] == [("a", ""), ("b", ""), ("link", "a")]


def test_libraries_that_every_system_has_stay_out(tmp_path):
    """Their copies inside packages stay, because they have names of their own."""
    names = ("libstdc++.so.6", "libX11.so.6", "libXft.so.2", "libxcb.so.1", "numpy.libs/libstdc++.so.6")
    names += (
        "pyoidn/oidn/lib/libOpenImageDenoise_device_cuda.so.2",
        "pyoidn/oidn/lib/libOpenImageDenoise_device_cpu.so.2",
    )
    for name in names:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    (tmp_path / "libcuda.so").symlink_to(names[-2])
    remove_libraries(tmp_path)
    left = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.so*")}
    assert left == {"libXft.so.2", "numpy.libs/libstdc++.so.6", names[-1]}


def test_nothing_tells_where_packages_were_installed(tmp_path):
    kept = ["av.dist-info/METADATA", "av.dist-info/licenses/AUTHORS.py", "av/a.pyc"]
    traces = ["av.dist-info/RECORD", "av.dist-info/licenses/__pycache__/AUTHORS.cpython-311.pyc"]
    for name in (*kept, *traces):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    remove_traces(tmp_path)
    assert sorted(str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()) == kept


def test_copies_become_links(tmp_path):
    for name in ("liba.so", "liba.so.1", "liba.so.1.2", "libb.so"):
        (tmp_path / name).write_text(name[:4])
    link_copies(tmp_path)
    assert {path.name for path in tmp_path.iterdir() if path.is_symlink()} == {"liba.so", "liba.so.1"}
    assert all((tmp_path / name).read_text() == name[:4] for name in ("liba.so", "liba.so.1", "libb.so"))
