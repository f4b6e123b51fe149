"""Any model as an FMU for co-simulation, after the Functional Mock-up Interface 2.0.

`model_interface` defines what a model must offer, `functions` offers it to importers, `package` makes an FMU of it.
"""
