"""The rope as an object: its simulation, its parameter sensitivities, and its co-simulation slave."""
