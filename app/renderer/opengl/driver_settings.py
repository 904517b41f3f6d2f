"""What the driver of OpenGL is told by variables of the environment, as a value that is handed to whoever opens it.

Mesa reads these variables when it is loaded and when a context is made, from the environment of the process and
nowhere else: EGL has no attributes for them. So `apply` changes the environment for the moment in which a context is
opened. Nothing else of this process may open one or start processes meanwhile.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType

from msgspec import Struct, field


class DriverSettings(Struct, frozen=True):
    """Variables that are `set` while a context is opened, and those that are `removed`."""

    set: Mapping[str, str] = field(default_factory=lambda: MappingProxyType[str, str]({}))
    removed: tuple[str, ...] = ()

    @contextmanager
    def apply(self) -> Iterator[None]:
        """Inside, the environment has these settings; afterwards it is as before.

        A process that has opened a context already keeps what the driver chose then.
        """
        before = {name: os.environ.get(name) for name in (*self.set, *self.removed)}
        for name in self.removed:
            os.environ.pop(name, None)
        os.environ.update(self.set)
        try:
            yield
        finally:
            for name, text in before.items():
                if text is None:
                    os.environ.pop(name, None)
                else:
                    os.environ[name] = text


USER_DRIVER = DriverSettings()
"""The driver as the system and the user have set it up."""
