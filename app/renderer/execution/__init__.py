"""Plans under way: what is decoded, executed and downloaded, whole or by tiles."""
