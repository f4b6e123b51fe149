"""Optimisation of trip profiles, input shapers and servo gains for the smallest swing of the rope."""
