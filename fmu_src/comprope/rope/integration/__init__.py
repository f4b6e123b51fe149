"""Newmark-beta time integration, static equilibrium, and the path from inputs to outputs."""
