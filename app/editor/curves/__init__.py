"""Values over time: a dope sheet and a curve editor in one panel."""
