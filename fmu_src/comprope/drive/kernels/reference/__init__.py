"""Kernels of the reference: S-curves and free-form trips, smoothed and shaped."""
