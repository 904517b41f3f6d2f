"""Recognizes the layers of a render: names, conventions, cameras, mattes."""
