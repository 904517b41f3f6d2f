"""What the layers of a render are: names, conventions, cameras, mattes."""
