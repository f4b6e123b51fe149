"""Commands that simulate, and that make what simulations need."""
