"""One job on many ranks: see ../README.md."""
