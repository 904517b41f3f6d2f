"""`halation cache`: what the driver has compiled is carried, and hostile archives change nothing."""

from __future__ import annotations

import json
import stat
import zipfile
from pathlib import Path
from random import Random

import pytest
from halation.renderer.opengl.shader_cache import DISABLING

PROGRAM = f"mesa_shader_cache/ab/{'0' * 38}"
OTHER = f"mesa_shader_cache/cd/{'1' * 38}"
RECORD = f"mesa_shader_cache/halation-{'2' * 16}"


@pytest.fixture
def base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a cache with one program and a record of it."""
    for name in DISABLING:
        monkeypatch.delenv(name, raising=False)
    return use_cache(tmp_path / "base", monkeypatch, {PROGRAM: b"code", RECORD: b"11111111"})


def use_cache(base: Path, monkeypatch: pytest.MonkeyPatch, files: dict[str, bytes]) -> Path:
    base.mkdir()
    for name, content in files.items():
        (base / name).parent.mkdir(parents=True, exist_ok=True)
        (base / name).write_bytes(content)
    monkeypatch.setenv("MESA_SHADER_CACHE_DIR", str(base))
    return base


def read_files(base: Path) -> dict[str, bytes]:
    return {path.relative_to(base).as_posix(): path.read_bytes() for path in base.rglob("*") if path.is_file()}


def change_archive(path: Path, target: Path, members: dict[str | zipfile.ZipInfo, bytes], **header: object) -> Path:
    """An archive with other members, and other words in its header."""
    with zipfile.ZipFile(path) as archive:
        fields = json.loads(archive.read("halation-cache.json")) | header
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("halation-cache.json", json.dumps(fields))
        for name, content in members.items():
            archive.writestr(name, content)
    return target


def test_a_cache_is_carried(cli, base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (base / "mesa_shader_cache" / "index").write_bytes(b"the driver makes its own")
    archive = tmp_path / "cache.zip"
    assert cli("cache", "--export", archive, "--json").json == {"exported": 2, "path": str(archive)}
    other = use_cache(tmp_path / "other", monkeypatch, {})
    assert cli("cache", "--import", archive, "--json").json == {"imported": 2, "path": str(archive)}
    assert read_files(other) == {PROGRAM: b"code", RECORD: b"11111111"}


def test_what_is_there_stays(cli, base: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs of both, and the hashes of both in the record; a second time nothing is new."""
    archive = tmp_path / "cache.zip"
    cli("cache", "--export", archive)
    files = {PROGRAM: b"own code", OTHER: b"more", RECORD: b"22222222"}
    other = use_cache(tmp_path / "other", monkeypatch, files)
    assert cli("cache", "--import", archive, "--json").json["imported"] == 1
    assert read_files(other) == {**files, RECORD: b"2222222211111111"}
    assert cli("cache", "--import", archive, "--json").json["imported"] == 0


@pytest.mark.parametrize("field", ["renderer", "driver", "processor"])
def test_the_cache_of_another_driver_is_refused(cli, base: Path, tmp_path: Path, field: str) -> None:
    cli("cache", "--export", tmp_path / "cache.zip")
    changed = change_archive(tmp_path / "cache.zip", tmp_path / "other.zip", {OTHER: b"code"}, **{field: "Mesa 99"})
    result = cli("cache", "--import", changed)
    assert result.code != 0 and "Mesa 99" in result.err and "this machine has" in result.err
    assert OTHER not in read_files(base)


def make_link() -> zipfile.ZipInfo:
    link = zipfile.ZipInfo(OTHER)
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    return link


@pytest.mark.parametrize(
    "member",
    [
        "mesa_shader_cache/../../outside",
        "../outside",
        "/tmp/outside",
        "mesa_shader_cache/ab/..",
        f"mesa_shader_cache\\ab\\{'0' * 38}",
        f"{OTHER}\n",
        "mesa_shader_cache/index",
        "other/ab/00",
        make_link(),
    ],
    ids=str,
)
def test_members_that_are_no_programs_are_refused(cli, base: Path, tmp_path: Path, member) -> None:
    """Before anything is written, also of the good members."""
    cli("cache", "--export", tmp_path / "cache.zip")
    before = sorted(path for path in tmp_path.rglob("*") if path.is_file())
    archive = change_archive(
        tmp_path / "cache.zip", tmp_path / "bad.zip", {f"mesa_shader_cache/ef/{'3' * 38}": b"", member: b"x"}
    )
    result = cli("cache", "--import", archive)
    assert result.code != 0 and "is no file of a cache" in result.err and str(archive) in result.err
    assert sorted(path for path in tmp_path.rglob("*") if path.is_file()) == sorted([*before, archive])


def test_an_archive_that_unpacks_to_too_much(cli, base: Path, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr("halation.renderer.opengl.cache_archive.MAX_BYTES", 10_000)
    cli("cache", "--export", tmp_path / "cache.zip")
    archive = change_archive(tmp_path / "cache.zip", tmp_path / "bomb.zip", {OTHER: bytes(20_000)})
    result = cli("cache", "--import", archive)
    assert archive.stat().st_size < 10_000 and result.code != 0 and "no cache is as large" in result.err
    assert OTHER not in read_files(base)


@pytest.mark.parametrize("limit", ["MAX_BYTES", "MAX_FILES"])
def test_the_largest_archive_is_imported_and_one_more_is_not(
    cli, base: Path, tmp_path: Path, monkeypatch, limit: str
) -> None:
    """Both limits count the header too, and what is unpacked."""
    cli("cache", "--export", tmp_path / "cache.zip")
    archive = change_archive(tmp_path / "cache.zip", tmp_path / "other.zip", {PROGRAM: b"code", OTHER: bytes(5000)})
    with zipfile.ZipFile(archive) as opened:
        sizes = [member.file_size for member in opened.infolist()]
    most = {"MAX_BYTES": sum(sizes), "MAX_FILES": len(sizes)}[limit]
    monkeypatch.setattr(f"halation.renderer.opengl.cache_archive.{limit}", most - 1)
    result = cli("cache", "--import", archive)
    assert result.code == 4 and f"{archive}: has more than" in result.err and OTHER not in read_files(base)
    monkeypatch.setattr(f"halation.renderer.opengl.cache_archive.{limit}", most)
    assert cli("cache", "--import", archive, "--json").json["imported"] == 1
    assert read_files(base)[OTHER] == bytes(5000)


def test_a_file_or_folder_that_is_a_link_is_left_out_of_an_export(cli, base: Path, tmp_path: Path) -> None:
    """It may lead anywhere; a link to a program of the cache too."""
    (tmp_path / "secret").write_bytes(b"secret")
    (base / OTHER).parent.mkdir()
    (base / OTHER).symlink_to(tmp_path / "secret")
    (base / f"mesa_shader_cache/cd/{'4' * 38}").symlink_to(base / PROGRAM)
    assert cli("cache", "--export", tmp_path / "cache.zip", "--json").json["exported"] == 2
    with zipfile.ZipFile(tmp_path / "cache.zip") as archive:
        assert {*archive.namelist()} == {"halation-cache.json", PROGRAM, RECORD}


def test_a_header_that_is_too_large_or_holds_no_owner(cli, base: Path, tmp_path: Path) -> None:
    cli("cache", "--export", tmp_path / "cache.zip")
    with zipfile.ZipFile(tmp_path / "cache.zip") as archive:
        header = archive.read("halation-cache.json")
    for number, text in enumerate((header + b" " * 10**6, b"{}", b"[]", b"{", b"[" * 9000, b'{"renderer": 1}')):
        with zipfile.ZipFile(tmp_path / f"{number}.zip", "w") as archive:
            archive.writestr("halation-cache.json", text)
            archive.writestr(OTHER, b"code")
        result = cli("cache", "--import", tmp_path / f"{number}.zip")
        assert result.code == 4 and "is no archive that halation cache --export has written" in result.err, text[:20]
        assert OTHER not in read_files(base)


def test_a_folder_that_is_a_link_is_not_written_through(cli, base: Path, tmp_path: Path) -> None:
    cli("cache", "--export", tmp_path / "cache.zip")
    archive = change_archive(tmp_path / "cache.zip", tmp_path / "link.zip", {OTHER: b"code"})
    (tmp_path / "outside").mkdir()
    (base / "mesa_shader_cache" / "cd").symlink_to(tmp_path / "outside")
    assert cli("cache", "--import", archive, "--json").json["imported"] == 0
    assert not list((tmp_path / "outside").iterdir())


def test_what_is_no_archive(cli, base: Path, tmp_path: Path) -> None:
    (tmp_path / "text.zip").write_text("text")
    with zipfile.ZipFile(tmp_path / "empty.zip", "w") as archive:
        archive.writestr("other", "")
    for name, words in (
        ("text.zip", "is damaged"),
        ("empty.zip", "is no archive that"),
        ("none.zip", "none.zip: cannot be read"),
    ):
        result = cli("cache", "--import", tmp_path / name)
        assert result.code != 0 and words in result.err and "Traceback" not in result.err
    result = cli("cache", "--import", tmp_path)
    assert (result.code, result.err) == (4, f"halation: {tmp_path}: cannot be read: Is a directory\n")


@pytest.mark.parametrize("method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_damaged_archives(cli, base: Path, tmp_path: Path, monkeypatch, method: int) -> None:
    """Each kind of compression has exceptions of its own. Nothing that is not whole is imported."""
    assert cli("cache", "--export", tmp_path / "whole.zip").code == 0
    with zipfile.ZipFile(tmp_path / "whole.zip") as archive:
        header = archive.read("halation-cache.json")
    with zipfile.ZipFile(tmp_path / "other.zip", "w", method) as archive:
        archive.writestr("halation-cache.json", header)
        archive.writestr(OTHER, b"code of another program" * 20)
    whole, rng = (tmp_path / "other.zip").read_bytes(), Random(method)
    for number in range(60):
        damaged = bytearray(whole)
        damaged[rng.randrange(len(damaged))] ^= rng.randrange(1, 256)
        (tmp_path / "damaged.zip").write_bytes(damaged)
        base = use_cache(tmp_path / f"base{number}", monkeypatch, {PROGRAM: b"code"})
        result = cli("cache", "--import", tmp_path / "damaged.zip")
        assert result.code in (0, 4), result
        assert read_files(base).get(OTHER, b"code of another program" * 20) == b"code of another program" * 20


def test_nothing_to_export(cli, base: Path, tmp_path: Path, monkeypatch) -> None:
    use_cache(tmp_path / "none", monkeypatch, {})
    result = cli("cache", "--export", tmp_path / "cache.zip")
    assert result.code != 0 and "nothing to export" in result.err and not (tmp_path / "cache.zip").exists()
    monkeypatch.setenv("MESA_SHADER_CACHE_DISABLE", "true")
    assert "nothing to export" in cli("cache", "--export", tmp_path / "cache.zip").err
    assert "give either" in cli("cache").err
