"""Checks of user-defined effects: what a file may hold, and whether its kernels are consistent."""
