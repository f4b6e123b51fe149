"""Indices of the rope's inputs: motion of its ends, and acceleration of the building's base."""

# Heights of the ends [m], their velocities and accelerations (up positive), their outward displacements [m], and the acceleration
# of the base towards the counterweight's side [m/s2].
CAR, COUNTERWEIGHT, CAR_V, CAR_A, COUNTERWEIGHT_V, COUNTERWEIGHT_A, CAR_OUT, COUNTERWEIGHT_OUT, BASE_A = range(9)
INPUTS = 9
