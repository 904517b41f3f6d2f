"""Results of cases."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from pathlib import Path
from typing import Any, Literal

from msgspec import Struct
from msgspec.structs import asdict

from ..media.comparison.metrics import PictureDifference
from .cases import Case

Status = Literal["passed", "failed", "blessed", "skipped"]


class PictureViews(Struct, frozen=True):
    """PNG files of what was rendered, what was expected and the amplified difference; the last two may be missing."""

    actual: bytes
    expected: bytes = b""
    difference: bytes = b""
    gain: float = 1.0


class PictureCheck(Struct, frozen=True):
    """A picture against its golden. `layer` is the one that is worst; `value` is the case's metric there.

    `sentence` says what is wrong, "" if nothing is. `golden_by` and `made_by` are the renderers of both pictures.
    `files` are the pictures that were left for people.
    """

    golden: Path
    frame: int
    layer: str = ""
    value: float | None = None
    compared: PictureDifference | None = None
    sentence: str = ""
    golden_by: str = ""
    made_by: str = ""
    views: PictureViews | None = None
    files: tuple[Path, ...] = ()

    @property
    def elsewhere(self) -> str:
        """A remark if another renderer made the golden, "" if not."""
        if not self.golden_by or not self.made_by or self.golden_by == self.made_by:
            return ""
        return f"the golden was made by {self.golden_by}; this is {self.made_by}"


class Outcome(Struct, frozen=True):
    """The outcome of a case. `sentence` says why it failed or was skipped, or which golden was written."""

    case: Case
    status: Status
    sentence: str = ""
    seconds: float = 0.0
    checks: tuple[PictureCheck, ...] = ()

    @property
    def worst(self) -> PictureCheck | None:
        """The picture to look at first: one that fails, else one with a measure."""
        measured = [check for check in self.checks if check.value is not None]
        return next((check for check in self.checks if check.sentence), measured[0] if measured else None)


class CaseResult(Struct, frozen=True):
    """The outcome of a case, and the device that it ran on."""

    outcome: Outcome
    device: str
    software: bool


class RegressionRun(Struct, frozen=True):
    """All outcomes in order, and what they were made with. `remark` says what could not be pinned."""

    outcomes: Sequence[Outcome]
    device: str
    seconds: float
    deterministic: bool
    remark: str = ""
    version: str = ""

    def count(self, status: Status) -> int:
        """How many cases ended so."""
        return sum(item.status == status for item in self.outcomes)

    @property
    def summary(self) -> str:
        """One line that says how it went."""
        names: tuple[Status, ...] = ("failed", "passed", "blessed", "skipped")
        parts = [f"{self.count(name)} {name}" for name in names if self.count(name)]
        return f"{', '.join(parts) or 'no cases'} in {self.seconds:.2f} s"


def as_json(session: RegressionRun) -> dict[str, Any]:
    """For machines. Infinity and NaN, which JSON does not know, are null."""
    return {
        "device": session.device,
        "deterministic": session.deterministic,
        "remark": session.remark,
        "version": session.version,
        "seconds": round(session.seconds, 4),
        **{name: session.count(name) for name in ("passed", "failed", "blessed", "skipped")},
        "cases": [_case(item) for item in session.outcomes],
    }


def _case(outcome: Outcome) -> dict[str, Any]:
    case = outcome.case
    return {
        "id": case.id,
        "suite": str(case.suite),
        "name": case.name,
        "graph": str(case.graph),
        "status": outcome.status,
        "message": outcome.sentence,
        "seconds": round(outcome.seconds, 4),
        "metric": case.metric,
        "tolerance": case.tolerance,
        "checks": [_check(check) for check in outcome.checks],
    }


def _check(check: PictureCheck) -> dict[str, Any]:
    measures = asdict(check.compared) if check.compared else {}
    return {
        "golden": str(check.golden),
        "frame": check.frame,
        "layer": check.layer,
        "value": _plain(check.value),
        "message": check.sentence,
        "golden_by": check.golden_by,
        "made_by": check.made_by,
        **{name: _plain(item) for name, item in measures.items()},
        "files": [str(path) for path in check.files],
    }


def _plain(item: Any) -> Any:
    if isinstance(item, tuple | list):
        return [_plain(part) for part in item]  # pyright: ignore[reportUnknownVariableType]
    return None if isinstance(item, float) and not isfinite(item) else item
