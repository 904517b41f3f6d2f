"""Color: OpenColorIO configs, the working space, views, and color spaces of files."""
