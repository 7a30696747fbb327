"""Compares image jobs for resin printers with PrusaSlicer's."""
