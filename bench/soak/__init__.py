"""Slices good and bad files in batch mode for hours: see ../README.md."""
