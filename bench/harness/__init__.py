"""Code shared by the comparisons: measured processes, parts, tables and charts."""
