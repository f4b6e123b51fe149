"""Any model as an FMU for co-simulation, after the Functional Mock-up Interface 2.0.

`model_interface` defines what a model must offer, `pythonfmu_slave` makes a slave of it, `package` an FMU.
"""
