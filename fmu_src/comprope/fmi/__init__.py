"""The face of a model to the Functional Mock-up Interface 2.0 (co-simulation), whatever the model computes.

`engine` says what a model must offer, `face` makes a pythonfmu slave of it, `build` an FMU.
"""
