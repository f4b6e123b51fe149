"""Motions fitted to a signal: smoothing splines, jerk-limited trips, and the smoothest motion within the noise."""
