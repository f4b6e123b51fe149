"""Compensation ropes of elevators: the rope, the drive, and their interface to FMI (Functional Mock-up Interface).

Every import inside this package is relative, so that a copy of it can live inside an FMU
under a name of its own and never meets another copy in the same process.
"""
