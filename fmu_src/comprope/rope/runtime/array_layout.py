"""Sections of the flat workspaces that the kernels share.

A rope of n nodes uses columns 0 .. n-1 of every section and the sheave uses column n, so each
section is m = n + 1 long and entry i of section S sits at S * m + i. Positions, velocities,
accelerations and forces have two sections: x (down), then y (towards the counterweight); the
sheave's column holds its vertical displacement and its angle.
"""

# Segment e joins nodes e and e + 1: unit tangent, 1 / length, tension, spin of the tangent, shear, force.
TX, TY, INVERSE, TENSION, SPIN, SHEAR, FX, FY = range(8)
# Node: curvature, bending moment, what effects add to its derivative by curvature, rate of curvature.
CURVATURE, MOMENT, STIFF, BEND_RATE = range(8, 12)
# Segment blocks of the tangent, the gradient of the segment's angle, and the node's stiffness against bending.
SXX, SXY, SYY, WX, WY, BENDING = range(12, 18)
# Segment: share of a rod's stiffness (see `axial_law`); the sheave's column counts the segments that are pushed or shortened.
SHARE = 18
SECTIONS = 19

# Symmetric block band of the tangent: node with itself, with the next node, with the one after.
DXX, DXY, DYY, EXX, EXY, EYX, EYY, GXX, GXY, GYX, GYY = range(11)
BAND = 11

# Contact tangent, which friction makes unsymmetric: blocks of node i with i-2 .. i+2 (4 entries each),
# then with the sheave's height and angle (columns), then of the sheave's rows with the node.
COLUMNS = 20
ROWS = 24
CONTACT = 28

# Small results of the contact kernel.
FORCE_X, ELASTIC, NORMAL_LOSS, FRICTION_LOSS, FIRST, LAST = range(6)
CONTACT_RESULTS = 6
