"""Broken meshes as each slicer sees them: see ../README.md."""
