"""What `bench/rivals` and `bench/paper` share: processes measured from outside, parts, tables and charts."""
