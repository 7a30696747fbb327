"""Lamella beside the slicers of today: see ../README.md."""
