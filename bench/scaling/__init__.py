"""One job on many processes: see ../README.md."""
