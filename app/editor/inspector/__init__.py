"""Panel of what is selected: its values, links and descriptions, and the fields to edit them."""

from __future__ import annotations
