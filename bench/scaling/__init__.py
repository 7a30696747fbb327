"""Runs one job on many processes: see ../README.md."""
