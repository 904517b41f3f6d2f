"""What is generated from the code is up to date. `./dev renew` writes all of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from generated_pages import PAGES, renew

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("page", PAGES)
def test_a_generated_page_is_up_to_date(page: str) -> None:
    current = (ROOT / page).read_text(encoding="utf-8") == renew(page)
    assert current, f"{page} is not up to date: ./dev renew writes it (python tests/generated_pages.py does the same)"
