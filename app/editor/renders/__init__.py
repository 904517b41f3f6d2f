"""The Renders panel: a form for renders to files, and the queue of them."""
