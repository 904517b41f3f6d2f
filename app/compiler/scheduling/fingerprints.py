"""Keys of pictures: equal keys mean equal pixels. Everything that pixels depend on is hashed, and nothing else.

A key is found in two steps. The fingerprint of a pass is a hash of all that decides what it makes, except the pictures
that it reads: the identities of its operations (see `ir.identity`), the texts of the shader files that they call, what
each one reads by its place in the pass, and the formats of textures. The key of a picture is a hash of the fingerprint
of the pass that makes it and of the keys of what this pass reads.

Two steps, because the first one is slow and stays: while a value is dragged, one pass has another fingerprint, and all
passes after it only other keys. Texts of shaders are hashed per file, once for the life of a library.

Several results may share a pass, and which ones do depends on the whole graph. So each has the fingerprint of the pass
that would make it alone: a change of one leaves the keys of the others, and their cached pixels, as they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from types import MappingProxyType

from ..fusion.fuse import PassGroup
from ..fusion.rewrites import split_by_result
from ..ir import LoweredProgram, Op, Ref, SourceOp
from ..ir.identity import hash_description, hash_parts
from ..library import Library
from ..target import Target

Fingerprint = tuple[PassGroup, str]
"""A pass that makes the results of one operation, and a hash of all that decides them but the pictures that it reads.
"""


class PassFingerprints:
    """Finds the fingerprints of passes. Equal ones mean equal shaders, set to equal values.

    `known` are descriptions of operations that are the same as before, in a plan for the same frame.
    """

    def __init__(
        self,
        program: LoweredProgram,
        library: Library,
        target: Target,
        formats: Mapping[Ref, str],
        known: Mapping[int, str] = MappingProxyType({}),
    ) -> None:
        self._program, self._library, self._formats = program, library, formats
        self._target = target
        self._uniforms = {"proxy": program.scale, "frame": program.frame}
        self.descriptions = dict(known)
        """A hash of all that decides what an operation makes, but the pictures that it reads, by its number."""

    def of(self, group: PassGroup) -> tuple[Fingerprint, ...]:
        """The fingerprint of each result of a pass, as if the pass made nothing else."""
        return tuple((part, self._fingerprint(part)) for part in split_by_result(self._program, group))

    def renew(self, before: tuple[Fingerprint, ...]) -> tuple[Fingerprint, ...]:
        """The fingerprints of a pass in which only numbers are others than `before`."""
        return tuple((part, self._fingerprint(part)) for part, _ in before)

    def _fingerprint(self, group: PassGroup) -> str:
        """Pictures are told apart by their place: first those that the pass reads, then what it makes, in order."""
        ops, parts, target = self._program.ops, list[object](), self._target
        by_image = target.has_images_for(len(group.reads) + len(group.writes))
        places = {ref: number for number, ref in enumerate(group.reads)}
        for index in group.members:
            op = ops[index]
            parts.append(self._describe(index, op))
            for ref in op.reads():
                parts += [places[ref], self._program.has_no_holes(op, ref, by_image)]
            for output in range(op.outputs):
                places[Ref(index, output)] = len(places)
        root = ops[group.root]
        form = "fragment" if root.is_fragment_only else target.form
        written = [places[ref] for ref in group.writes]
        textures = self._describe_textures((*group.reads, *group.writes))
        return hash_description((form, target.rounds_halves, parts, written, textures))

    def _describe_textures(self, refs: Iterable[Ref]) -> list[object]:
        """How pictures are stored on the device."""
        program, formats = self._program, self._formats
        return [(*program.shape(ref).size, formats[ref], *_describe_window(program, ref)) for ref in refs]

    def _describe(self, index: int, op: Op) -> str:
        """An operation, the texts that it calls, and the uniforms of the whole pass that it reads."""
        if index not in self.descriptions:
            files = self._library.digest(op.files, op.owner) if op.files else ""
            uniforms = [self._uniforms[name] for name in sorted(op.find_uniforms(self._library))]
            self.descriptions[index] = hash_description((op.identity, files, uniforms))
        return self.descriptions[index]


def find_keys(
    program: LoweredProgram, fingerprints: Sequence[tuple[Fingerprint, ...]], needed: Iterable[Ref]
) -> dict[Ref, str]:
    """The key of every picture. `fingerprints` are those of all passes."""
    keys: dict[Ref, str] = {}
    update_keys(keys, program, needed, fingerprints, range(len(fingerprints)))
    return keys


def update_keys(
    keys: dict[Ref, str],
    program: LoweredProgram,
    sources: Iterable[Ref],
    fingerprints: Sequence[tuple[Fingerprint, ...]],
    changed: Iterable[int],
) -> Set[Ref]:
    """Bring `keys` up to date where `sources`, or the fingerprints of the passes that `changed`, are others.

    Passes stand in the order in which they run, so one walk is enough: what a pass reads has its key by then. Returns
    the pictures that have other keys than before.
    """
    changed_refs: set[Ref] = set()

    def enter(ref: Ref, key: str) -> None:
        if keys.get(ref) != key:
            keys[ref] = key
            changed_refs.add(ref)

    for ref in sources:
        op = program.ops[ref.op]
        if isinstance(op, SourceOp):
            key = op.key(ref.output)
            enter(ref, key if isinstance(key, str) else hash_parts(key, *_describe_window(program, ref)))
    changed_passes = frozenset(changed)
    for number, parts in enumerate(fingerprints):
        for group, fingerprint in parts:
            if number in changed_passes or not changed_refs.isdisjoint(group.reads):
                key = hash_parts(fingerprint, *(keys[ref] for ref in group.reads))
                for place, ref in enumerate(group.writes):
                    enter(ref, f"{key}.{place}")
    return changed_refs


def _describe_window(program: LoweredProgram, ref: Ref) -> tuple[object, ...]:
    """Which part of a picture it is, where it is not its frame; and how far it goes on, where it does."""
    window, extent = program.window(ref), program.extents.get(ref)
    return (window, extent) if extent else (window,) if window else ()
