"""What commands say of plug-ins that cannot be loaded."""

from __future__ import annotations

from .outcome import note


def refused_plugins() -> list[dict[str, str]]:
    """Each plug-in that cannot be loaded: its package, version and fault."""
    from halation.nodes import plugins

    return [
        {"package": plugin.package, "version": plugin.version, "fault": plugin.fault}
        for plugin in plugins()
        if plugin.fault
    ]


def note_refused_plugins() -> None:
    """Say on standard error which plug-ins cannot be loaded, and why."""
    for plugin in refused_plugins():
        note(f"the plug-in {plugin['package']} {plugin['version']} cannot be loaded: {plugin['fault']}")
