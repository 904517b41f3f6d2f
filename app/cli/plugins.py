"""How commands report plug-ins that cannot be loaded."""

from __future__ import annotations

from .outcome import print_note


def list_refused_plugins() -> list[dict[str, str]]:
    """The plug-ins that cannot be loaded: package, version and fault of each."""
    from halation.nodes import plugins

    return [
        {"package": plugin.package, "version": plugin.version, "fault": plugin.fault}
        for plugin in plugins()
        if plugin.fault
    ]


def describe_refused_plugins() -> dict[str, list[dict[str, str]]]:
    """The plug-ins that cannot be loaded, as an entry for JSON; empty if there are none."""
    refused_plugins = list_refused_plugins()
    return {"refused_plugins": refused_plugins} if refused_plugins else {}


def print_refused_plugins() -> None:
    """Print to standard error which plug-ins cannot be loaded, and why."""
    for plugin in list_refused_plugins():
        print_note(f"the plug-in {plugin['package']} {plugin['version']} cannot be loaded: {plugin['fault']}")
