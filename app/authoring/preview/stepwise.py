"""Work that goes on in small steps between the frames of a window, while somebody looks at what it makes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Generator

from ...errors import HalationError


class StepwiseWork(ABC):
    """A generator does one step per `work`; who shows what it makes sets `is_shown` in each frame."""

    def __init__(self) -> None:
        self._steps: Generator[None] | None = None
        self.is_shown = False
        """True if somebody has looked since the last frame."""

    def work(self) -> bool:
        """Do the next step; True while there are more."""
        if self._steps is None:
            return False
        try:
            next(self._steps)
        except StopIteration:
            self._steps = None
        except HalationError as error:
            self._steps = None
            self._note_failure(error)
        return self._steps is not None

    def stop(self) -> None:
        """End what is under way. What it has made so far stays."""
        steps, self._steps = self._steps, None
        if steps is not None:
            steps.close()

    @abstractmethod
    def _note_failure(self, error: HalationError) -> None:
        """The steps have ended with this error."""
        ...
