"""The compensation rope on its free sheave: eq. (1) and (2), their solver, and the effects that can be added.

Imports go one way: runtime <- linalg, mechanics <- effects, integration <- sensitivity <- compiler <- simulator.
"""
