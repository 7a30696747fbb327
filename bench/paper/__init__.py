"""Measures the tables of the EECC paper again: see ../README.md."""
