"""A virtual tower that knows nothing of `comprope`'s kernels: what the diagnosis is judged against.

The paper's equations (1) and (2), written anew: nodal bending with the curvature of the circle that touches two segments,
contact at nodes, elements of 1 cm, generalised-alpha in time at 4 ms; and causes of trouble, in the library and outside it.
"""
