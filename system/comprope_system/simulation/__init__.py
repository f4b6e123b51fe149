"""Simulation of drive and rope: FMUs, co-simulation, moving buildings, and trips with their results, plots and animation."""
