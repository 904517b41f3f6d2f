"""Archives of Mesa's cache of compiled programs, which carry it to another machine with the same driver.

An archive is a zip file: a header that names driver and processor, and the files of the cache. An archive may come from
anywhere, so names, sizes and kinds of all members are checked before the first is written. What a driver finds in its
cache it runs, though: nobody should import what a stranger has made.
"""

from __future__ import annotations

import json
import re
import stat
from hashlib import blake2b
from pathlib import Path
from zipfile import ZipFile, ZipInfo

from msgspec import Struct

from ...errors import InputError, UsageError
from ...resources.archives import DAMAGED_ARCHIVE
from ...resources.atomic_write import replace_file, write_bytes_atomically
from ...resources.input_files import open_file
from ...resources.machine import describe_processor
from ...resources.sandbox import UNRESTRICTED, Sandbox
from ..device import Device
from .shader_cache import FOLDERS, find_base_folder, list_cache_folders

HEADER = "halation-cache.json"
MAX_BYTES = 2**30
"""What an archive may hold: as much as Mesa keeps by default (MESA_SHADER_CACHE_MAX_SIZE)."""
MAX_FILES = 2**17
"""Twice the programs of a full record (`MAX_RECORD_BYTES`)."""
_MAX_HEADER = 2**16
"""Bytes of the header, which has three short texts: about 200."""

_FILE = r"[0-9a-f]{2}/[0-9a-f]{38}|halation-[0-9a-f]{16}|(?:part\d{1,3}/)?mesa_cache\.(?:db|idx)"
_MEMBER = re.compile(rf"(?:{'|'.join(FOLDERS)})/(?:{_FILE})", re.ASCII)
"""A program, our record of them, or one of the two files of a database."""


class CacheOwner(Struct, frozen=True):
    """Whose programs a cache has: a driver finds only what the same driver has compiled for the same processor."""

    renderer: str
    driver: str
    processor: str

    @classmethod
    def of_device(cls, device: Device) -> CacheOwner:
        """The owner of what a device compiles."""
        processor = blake2b(describe_processor().encode(), digest_size=8).hexdigest()
        return cls(device.target.renderer, device.driver, processor)

    def __str__(self) -> str:
        return f"{self.renderer}, {self.driver}, processor {self.processor}"


def export_cache(path: Path, device: Device, *, sandbox: Sandbox) -> int:
    """Write the driver's cache into an archive, and return the number of its files. Raises UsageError, OutputError."""
    files = {
        member: file
        for folder in list_cache_folders()
        for file in sorted(folder.rglob("*"))
        if _MEMBER.fullmatch(member := f"{folder.name}/{file.relative_to(folder).as_posix()}") and _is_regular(file)
    }
    if not files:
        raise UsageError(f"{path}: there is nothing to export: the driver has no cache of programs, render first")
    with replace_file(path, sandbox) as replacement:
        with ZipFile(replacement.temporary, "w") as archive:
            archive.writestr(HEADER, json.dumps({"format": 1, **_owner_fields(CacheOwner.of_device(device))}))
            for member, file in files.items():
                archive.writestr(ZipInfo(member), file.read_bytes())
        replacement.commit()
    return len(files)


def import_cache(path: Path, device: Device, *, sandbox: Sandbox) -> int:
    """Add the programs of an archive to the driver's cache, and return how many files were new.

    Raises InputError for an archive of another driver, or one that is damaged or not made by `export_cache`.
    """
    base = find_base_folder()
    if base is None:
        raise UsageError(f"{path}: cannot be imported: the driver keeps no cache here")
    try:
        file = open_file(path, sandbox)
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
    with file:
        try:
            with ZipFile(file) as archive:
                return _import_members(path, archive, base, CacheOwner.of_device(device))
        except DAMAGED_ARCHIVE as error:
            raise InputError(f"{path}: is damaged, or no archive of a cache: {error}") from error


def _import_members(path: Path, archive: ZipFile, base: Path, owner: CacheOwner) -> int:
    members = archive.infolist()
    if sum(member.file_size for member in members) > MAX_BYTES or len(members) > MAX_FILES:
        raise InputError(f"{path}: has more than {MAX_FILES:,} files or {MAX_BYTES >> 20} MiB: no cache is as large")
    exported = _read_owner(path, archive)
    if exported != owner:
        raise InputError(f"{path}: is the cache of {exported}, and this machine has {owner}: export one here")
    programs = [member for member in members if member.filename != HEADER]
    for member in programs:
        kind = stat.S_IFMT(member.external_attr >> 16)
        if not _MEMBER.fullmatch(member.filename) or kind not in (0, stat.S_IFREG):
            raise InputError(f"{path}: member {member.filename!r:.100} is no file of a cache: nothing is imported")
    return sum(_write_member(archive, member, base) for member in programs)


def _write_member(archive: ZipFile, member: ZipInfo, base: Path) -> bool:
    """Write a file that is not there yet; what is there is the driver's. A record gets the hashes of both."""
    target, content = base / member.filename, archive.read(member)
    if target.parent.is_symlink() or (target.is_symlink() and not target.exists()):
        return False
    if target.exists():
        if not target.name.startswith("halation-"):
            return False
        stored = target.read_bytes()
        if content in stored:
            return False
        content = stored + content
    target.parent.mkdir(parents=True, exist_ok=True)
    write_bytes_atomically(target, content, UNRESTRICTED)
    return True


def _read_owner(path: Path, archive: ZipFile) -> CacheOwner:
    try:
        if archive.getinfo(HEADER).file_size > _MAX_HEADER:
            raise ValueError
        fields = json.loads(archive.read(HEADER))
        return CacheOwner(str(fields["renderer"]), str(fields["driver"]), str(fields["processor"]))
    except (KeyError, ValueError, TypeError, RecursionError):
        raise InputError(f"{path}: is no archive that halation cache --export has written") from None


def _owner_fields(owner: CacheOwner) -> dict[str, str]:
    return {"renderer": owner.renderer, "driver": owner.driver, "processor": owner.processor}


def _is_regular(file: Path) -> bool:
    return stat.S_ISREG(file.lstat().st_mode)
