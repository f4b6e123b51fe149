"""What correlates with the residual, and which force would explain it."""
