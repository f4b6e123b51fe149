"""Kernels of the drive: trips, servo and hoist, compiled for Python and for the FMU that needs no Python."""
