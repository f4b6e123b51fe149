"""The FMUs of rope and drive, and the system of both, from a model: also from an installed package."""
