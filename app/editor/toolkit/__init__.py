"""Widgets that all panels share. Each widget notes under a name where it is, in the `places` of its surface."""
