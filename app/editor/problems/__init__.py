"""The Problems panel: all errors and warnings."""
