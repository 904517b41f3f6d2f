"""The operation of a formula for pixels."""

from __future__ import annotations

from .operations import ColorCall


class FormulaCall(ColorCall, frozen=True, kw_only=True):
    """A pointwise function that was written for a formula of the user; it calls functions of the file `shader`."""

    @property
    def label(self) -> str:
        return "formula"

    @property
    def files(self) -> tuple[str, ...]:
        return (self.shader,)
