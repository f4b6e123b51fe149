"""Results of the paper, and verification of the numerics against closed forms."""
