"""The History panel: the steps that can be undone."""
