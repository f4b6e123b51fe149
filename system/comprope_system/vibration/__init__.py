"""Vibration of the rope by linearisation: natural modes, reduced linear models, swing in a swaying building."""
