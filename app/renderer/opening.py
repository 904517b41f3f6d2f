"""Opens a device and chooses the form of passes that suits it."""

from __future__ import annotations

from msgspec.structs import replace

from ..compiler import Form
from ..compiler.devices import choose_form
from ..resources.sandbox import Sandbox
from .calibration import load_or_measure
from .device import Device
from .opengl.context import open_current, open_standalone
from .opengl.device import OpenGLDevice
from .opengl.driver_settings import USER_DRIVER, DriverSettings


def open_device(
    form: Form | None = None, memory: int = 0, *, sandbox: Sandbox, driver: DriverSettings = USER_DRIVER
) -> Device:
    """Open OpenGL without a window. Raises DeviceError where there is none, or one that is too old.

    `form` overrides how passes are emitted; otherwise the table says, or what was measured at the first start. Plans
    use at most `memory` bytes of the device; 0 is as much as it has.
    """
    return _choose_form(open_standalone(driver), form, memory, sandbox=sandbox)


def adopt_window(form: Form | None = None, *, sandbox: Sandbox) -> Device:
    """The device of the window that is current on this thread. Raises DeviceError if its OpenGL is too old."""
    return _choose_form(open_current(), form, sandbox=sandbox)


def _choose_form(device: OpenGLDevice, form: Form | None, memory: int = 0, *, sandbox: Sandbox) -> Device:
    target = device.target
    chosen = choose_form(target.renderer, target.version, form, lambda: load_or_measure(device, sandbox=sandbox))
    return device.with_target(replace(target, form=chosen.form, why=chosen.why, memory=memory or target.memory))
