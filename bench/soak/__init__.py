"""Hours of good and bad files through the batch mode: see ../README.md."""
