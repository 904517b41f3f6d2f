"""The date of a render."""

from __future__ import annotations

import os
from datetime import UTC, datetime


def read_date() -> str:
    """The date of today in UTC, such as 2026-03-14; where SOURCE_DATE_EPOCH is set, the date that it says.

    That is how builds that are to be the same each time name their date (reproducible-builds.org).
    """
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    moment = datetime.fromtimestamp(int(epoch), UTC) if epoch.isdigit() else datetime.now(UTC)
    return moment.date().isoformat()
