"""Jobs of pictures for resin printers beside those of PrusaSlicer."""
