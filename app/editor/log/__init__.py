"""The Log panel, and the messages that appear in the corner of the window."""
