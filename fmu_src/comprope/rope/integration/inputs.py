"""Indices of the rope's inputs: heights, velocities, accelerations and lateral displacements of its ends."""

# Inputs of the ends: heights [m], velocities, accelerations (up positive), outward displacements [m].
CAR, COUNTERWEIGHT, CAR_V, CAR_A, COUNTERWEIGHT_V, COUNTERWEIGHT_A, CAR_OUT, COUNTERWEIGHT_OUT = range(8)
INPUTS = 8
