"""Direct solvers for the block-banded tangent with the border that contact and sheave add."""
