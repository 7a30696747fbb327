"""The tables of the EECC paper, measured again: see ../README.md."""
