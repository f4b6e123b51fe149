"""Commands from measurements to a better model."""
