"""Results of passes in files, which the processes that share the frames of a job have in common.

Where a node remembers earlier frames, most of a frame does not depend on them: blurs of the plate before that node, and
what comes after it. So a job is cut into stages, which several processes work on.

- `ahead`: what nodes with a memory read and does not depend on earlier frames, for each frame by itself.
- `history`: what is stored of each frame for the next one, in order. It reads the results of `ahead`.
- The frames themselves, in any order: each reads what the frame before has stored.

A stage leaves its results in a folder, in a file for each surface. The name of a file is a hash of all that its pixels
depend on, with the contents of files instead of their paths and dates, so it is the same on all machines. Correctness
does not depend on this folder: what is missing is computed, only more slowly.
"""

from __future__ import annotations

import shutil
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from ...compiler import Memory, Plan
from ...errors import OutputError, UsageError
from ...graph import Port
from ...resources.atomic_write import describe_write_error, replace_file
from ...resources.sandbox import Sandbox
from ..execution.decoding import Array
from ..execution.run import find_needed_passes
from ..execution.runner import Runner
from .header import compute_content_keys

FOLDER_PREFIX = ".halation-shared-"
_ABANDONED_AFTER = 86400.0
"""Seconds without a new file after which a folder belongs to a job that was killed: a choice, longer than a frame takes
anywhere."""

_RECENT_PLANS = 4
"""Plans whose keys are remembered: the pipeline works on three frames at a time."""


class StoredMemory(Struct, frozen=True):
    """What one node has stored of a frame, with a key that all machines agree on."""

    port: Port
    memory: Memory


class SharedResults:
    """The results in a folder. `hash_file` gives the hash of the content of a file."""

    def __init__(self, folder: Path, hash_file: Callable[[str], str], sandbox: Sandbox) -> None:
        if fault := sandbox.find_write_fault(folder):
            raise OutputError(f"{folder}: {fault}")
        if not folder.is_dir():
            for abandoned in list_abandoned_folders(folder.parent):
                remove_shared_folder(abandoned)
            create_folder(folder)
        self._folder, self._hash_file, self._sandbox = folder, hash_file, sandbox
        self._names = {path.name for path in folder.iterdir()}
        self._history_keys: dict[str, str] = {}
        """The keys of stored results for all machines, by those on this one."""
        self._recent_keys = deque[tuple[Plan, dict[int, str]]](maxlen=_RECENT_PLANS)

    def load_pixels(self, plan: Plan, number: int) -> Array | None:
        """The pixels of a surface as its texture holds them; None where no process has stored them."""
        name = self.find_name(plan, number)
        if name not in self._names:
            return None
        surface = plan.surfaces[number]
        width, height = surface.size
        dtype = np.dtype(np.float16 if surface.depth == "f2" else np.float32)
        try:
            pixels = np.fromfile(self._folder / name, dtype)
        except OSError:  # it is not needed any more, as others believe
            return None
        shape = (height, width, surface.channels)
        return pixels.reshape(shape) if pixels.size == width * height * surface.channels else None

    def store_surfaces(self, runner: Runner, plan: Plan, numbers: Iterable[int]) -> tuple[str, ...]:
        """Write surfaces that are on the device; the names of their files. Raises OutputError, for a full disk too."""
        names: list[str] = []
        for number in numbers:
            name = self.find_name(plan, number)
            names.append(name)
            if name in self._names:
                continue
            pixels = runner.download_surface(plan, number)
            with replace_file(self._folder / name, self._sandbox) as replacement:
                np.ascontiguousarray(pixels).tofile(replacement.temporary)
                replacement.commit(durable=False)
            self._names.add(name)
        return tuple(names)

    def describe_memories(self, plan: Plan) -> tuple[StoredMemory, ...]:
        """What a frame stores, for other processes."""
        keys = self._find_keys(plan)
        keys_here = {plan.surfaces[number].key: keys[number] for number in plan.remembered}
        return tuple(
            StoredMemory(port, replace(memory, key=keys_here[memory.key])) for port, memory in plan.memories.items()
        )

    def remove_files(self, names: Iterable[str]) -> None:
        """Remove files that no process needs any more."""
        for name in names:
            with suppress(OSError):
                (self._folder / Path(name).name).unlink()

    def find_name(self, plan: Plan, number: int) -> str:
        """The name of the file of a surface."""
        return sha256(self._find_keys(plan)[number].encode()).hexdigest()[:40]

    def _find_keys(self, plan: Plan) -> Mapping[int, str]:
        for recent_plan, keys in self._recent_keys:
            if recent_plan is plan:
                return keys
        paths = {item.picture.path for item in plan.uploads if not item.picture.in_memory}
        contents = {path: self._hash_file(path) for path in paths}
        keys = compute_content_keys(plan, contents, lambda surface: self._history_keys.get(surface.key, surface.key))
        self._history_keys |= {plan.surfaces[number].key: keys[number] for number in plan.remembered}
        self._recent_keys.append((plan, keys))
        return keys


def find_ahead_surfaces(plan: Plan) -> tuple[int, ...]:
    """The surfaces that the history of a plan reads, and that no earlier frame decides: where the stages are cut.

    Pictures that are only read from files are not among them: every process can do that.
    """
    makers = {number: index for index, render_pass in enumerate(plan.passes) for number in render_pass.targets}
    uploads = {item.surface for item in plan.uploads}
    following = {number for number in range(len(plan.surfaces)) if number not in makers and number not in uploads}
    history_passes: list[int] = []
    for index in find_needed_passes(plan, plan.remembered, ()):
        if not following.isdisjoint(plan.passes[index].textures):
            following.update(plan.passes[index].targets)
            history_passes.append(index)
    read = (number for index in history_passes for number in plan.passes[index].textures)
    return tuple(dict.fromkeys(number for number in read if number in makers and number not in following))


def has_stages(plan: Plan) -> bool:
    """True if some of a plan, which reads what the frame before stored, does not belong to the history."""
    needed = find_needed_passes(plan, plan.outputs.values(), ())
    history = find_needed_passes(plan, plan.remembered, ())
    return bool(set(needed) - set(history) or find_ahead_surfaces(plan))


def create_folder(folder: Path) -> None:
    """Create the folder of a job. Raises OutputError."""
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: cannot be created: {describe_write_error(error)}") from error


def remove_shared_folder(folder: Path) -> None:
    """Remove the results of a job. Raises UsageError for another folder."""
    if not folder.name.startswith(FOLDER_PREFIX):
        raise UsageError(f"{folder}: is no folder of shared results")
    shutil.rmtree(folder, ignore_errors=True)


def list_abandoned_folders(parent: Path) -> Iterator[Path]:
    """The folders of jobs that were killed."""
    for folder in parent.glob(f"{FOLDER_PREFIX}*"):
        with suppress(OSError):
            if time.time() - folder.stat().st_mtime > _ABANDONED_AFTER:
                yield folder
