"""The Inspector: the values, links and description of the selection, with fields to edit them."""

from __future__ import annotations
