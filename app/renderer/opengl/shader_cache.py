"""The folder in which Mesa keeps compiled programs, and the record of those that it has compiled for Halation.

Mesa does not say whether it has a program, and asking it by compiling costs as much as what it saves. So a file in its
own folder holds a hash of each program: it is gone whenever the cache is. If Mesa has dropped a program that the record
still names, the program is compiled when it first runs, as without a record.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from hashlib import blake2b
from pathlib import Path

from msgspec import Struct

FOLDERS = ("mesa_shader_cache_db", "mesa_shader_cache", "mesa_shader_cache_sf")
"""The names of Mesa's folder: as a database (the default of newer versions), as files, as a single file."""

DISABLING = ("MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE")

HASH_BYTES = 8
"""Bytes of a program's hash: that two of 65,536 programs have the same has a probability of 1e-10."""
MAX_RECORD_BYTES = 2**19
"""A record of 65,536 programs begins anew: Mesa, too, drops the oldest programs at some point. Chosen by judgement."""


def find_base_folder() -> Path | None:
    """The folder in which Mesa makes that of its cache: it asks the user database, not HOME. None without a cache."""
    if any(os.environ.get(name, "").lower() in ("1", "true", "yes", "y", "t") for name in DISABLING):
        return None
    for name in ("MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"):
        if folder := os.environ.get(name):
            return Path(folder)
    try:
        import pwd

        return Path(pwd.getpwuid(os.getuid()).pw_dir) / ".cache"
    except (ImportError, KeyError):  # Windows; a user without an entry
        return None


def list_cache_folders() -> tuple[Path, ...]:
    """Mesa's folders that exist."""
    base = find_base_folder()
    return tuple(folder for name in FOLDERS if (folder := base / name).is_dir()) if base else ()


class ProgramRecord(Struct, eq=False):
    """The hashes of programs that are in the cache of a driver."""

    path: Path | None
    """None where there is no cache, or where it cannot be written: then nothing that is compiled is found again."""

    _hashes: set[bytes]

    @classmethod
    def load(cls, driver: str) -> ProgramRecord:
        """Read the record of a driver, which is empty with an empty cache."""
        writable = [folder for folder in list_cache_folders() if os.access(folder, os.W_OK)]
        if not writable:
            return cls(None, set())
        folder = max(writable, key=lambda folder: folder.stat().st_mtime)
        path = folder / f"halation-{_hash(driver.encode()).hex()}"
        try:
            content = path.read_bytes()
        except OSError:
            content = b""
        if len(content) > MAX_RECORD_BYTES:
            path.unlink(missing_ok=True)
            content = b""
        return cls(path, {content[start : start + HASH_BYTES] for start in range(0, len(content), HASH_BYTES)})

    def __contains__(self, program: str) -> bool:
        return _hash(program.encode()) in self._hashes

    def add(self, programs: Iterable[str]) -> None:
        """Note programs that were compiled. Several processes may do so at once: a write of few bytes is whole."""
        added = {_hash(program.encode()) for program in programs} - self._hashes
        self._hashes |= added
        if self.path is None or not added:
            return
        try:
            with self.path.open("ab", buffering=0) as file:
                file.write(b"".join(sorted(added)))
        except OSError:  # the cache was deleted meanwhile, or the disk is full
            self.path = None


def _hash(content: bytes) -> bytes:
    return blake2b(content, digest_size=HASH_BYTES).digest()
