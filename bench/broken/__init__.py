"""Compares slicers on broken meshes: see ../README.md."""
