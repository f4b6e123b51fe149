"""Kernels: functions on arrays of numbers, compiled just in time for Python and ahead of time for C."""
