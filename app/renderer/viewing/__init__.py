"""Results on a screen, and numbers read back from them."""
