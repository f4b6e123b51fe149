"""Columns of a measured table: time in seconds, units, names, and faults of a signal."""
