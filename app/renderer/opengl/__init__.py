"""The device and what lives on it: programs, textures, meshes."""
