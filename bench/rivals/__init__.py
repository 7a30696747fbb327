"""Compares Lamella with other slicers: see ../README.md."""
