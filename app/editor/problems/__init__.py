"""The Problems panel: what is wrong now, and where."""
