"""The bar at the bottom of the window: frames, and playing them."""
