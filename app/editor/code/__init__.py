"""The panel in which the code of nodes is written."""
