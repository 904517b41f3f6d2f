"""What is sent to a worker: frames of a graph, with all that tells whether the worker would render the same pixels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from msgspec import Struct, field
from msgspec.structs import replace

from ..renderer.jobs.render_job import RenderJob
from ..renderer.jobs.shared_results import StoredMemory
from ..resources.struct_json import parse_struct, read_struct, write_struct


class FileMark(Struct, frozen=True):
    """The size of a file in bytes, and the SHA-256 of its content."""

    size: int
    digest: str


StageKind = Literal["check", "ahead", "history", "frames"]


class ChunkStage(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """What a chunk is in a job that is cut into stages (see `renderer.jobs.shared_results`).

    Results are shared in `folder`. `frames` are those of the stage; without any, the frames of the job are rendered.
    `memories` is what `frame_before` has stored. `drops` names files that nobody needs any more. A survey finds out
    whether a stage of its own for what lies ahead of the history is worth it.
    """

    kind: StageKind = "frames"
    folder: str = ""
    frames: tuple[int, ...] = ()
    frame_before: int = 0
    memories: tuple[StoredMemory, ...] = ()
    drops: tuple[str, ...] = ()
    is_survey: bool = False


class StageReport(Struct, frozen=True, omit_defaults=True):
    """What came of a stage: the seconds of each frame that is finished, the names of its files, and what it stores.

    `frame_bytes` is how much one frame stores. `ahead_pays` is what a survey has found.
    """

    seconds: Mapping[int, float] = field(default_factory=dict[int, float])
    names: Mapping[int, tuple[str, ...]] = field(default_factory=dict[int, tuple[str, ...]])
    memories: Mapping[int, tuple[StoredMemory, ...]] = field(default_factory=dict[int, tuple[StoredMemory, ...]])
    frame_bytes: int = 0
    ahead_pays: bool = False


class FrameChunk(Struct, frozen=True, omit_defaults=True, forbid_unknown_fields=True):
    """Some parts of a job: frames, or files where it has many.

    The `job` has the whole graph as its `document`, whose relative paths start at `folder`, and absolute paths. They
    are those of the machine that has sent it: `path_map` says where files are elsewhere. `marks` are the files that
    the frames read. `contents` are small files as base64, such as LUTs, by their paths.
    """

    job: RenderJob
    folder: str
    path_map: tuple[tuple[str, str], ...] = ()
    marks: Mapping[str, FileMark] = field(default_factory=dict[str, FileMark])
    contents: Mapping[str, str] = field(default_factory=dict[str, str])
    versions: Mapping[str, str] = field(default_factory=dict[str, str])
    """The version of everything that decides pixels, by its name (see `versions`)."""
    numbers: tuple[int, ...] = ()
    """Where the job has many files (`entries`): their numbers, from 1 on. They are its parts instead of its frames."""
    is_chain: bool = False
    """True if each frame needs the one before it."""
    stage: ChunkStage | None = None
    """None where each frame is rendered by itself, or one worker renders all of them."""
    topic: str = ""
    """The Dask topic to which finished frames are reported."""
    slots: Mapping[str, int] = field(default_factory=dict[str, int])
    """How many chunks are rendered side by side on a machine, by its name in the network."""

    @property
    def parts(self) -> tuple[int, ...]:
        """What is rendered each by itself: the numbers of its frames, or of its files."""
        return self.numbers or self.job.frames

    def take_parts(self, parts: tuple[int, ...]) -> FrameChunk:
        """The chunk with only these of its parts."""
        if not self.numbers:
            return replace(self, job=replace(self.job, frames=parts))
        entries = dict(zip(self.numbers, self.job.entries, strict=True))
        return replace(self, job=replace(self.job, entries=tuple(entries[number] for number in parts)), numbers=parts)

    def to_json(self) -> str:
        """The chunk as one line of JSON in ASCII."""
        return write_struct(self)

    @staticmethod
    def from_json(text: str) -> FrameChunk:
        """The chunk in a text of `to_json`. Raises UsageError for any other text."""
        return parse_struct(text, FrameChunk, "the text is not a chunk of frames")


class EntryOutcome(Struct, frozen=True, omit_defaults=True):
    """What came of one of many files: the frames that were rendered for it, and in how many passes."""

    frames: tuple[int, ...] = ()
    passes: int = 0


class ChunkReport(Struct, frozen=True, omit_defaults=True):
    """What came of a chunk on `worker`, as its address.

    `seconds` are those of each finished part; `faults` describe the parts that cannot be rendered. `death` says how
    the process ended that rendered, `refusal` why this worker can render no chunk of the job. `entries` say more where
    the parts are files.
    """

    worker: str
    seconds: Mapping[int, float] = field(default_factory=dict[int, float])
    kept: tuple[int, ...] = ()
    faults: Mapping[int, Mapping[str, Any]] = field(default_factory=dict[int, Mapping[str, Any]])
    costs: Mapping[str, Any] = field(default_factory=dict[str, Any])
    """The report of a render job, without its frames."""
    death: str = ""
    refusal: str = ""
    is_cancelled: bool = False
    stage: StageReport | None = None
    entries: Mapping[int, EntryOutcome] = field(default_factory=dict[int, EntryOutcome])

    def to_json(self) -> str:
        """The report as a line of JSON."""
        return write_struct(self)

    @staticmethod
    def from_json(text: str) -> ChunkReport:
        """The report in a text of `to_json`."""
        return read_struct(text, ChunkReport, strict=False)
