"""What the comparisons beside this folder share: processes measured from outside, parts, tables and charts."""
