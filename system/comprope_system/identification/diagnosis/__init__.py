"""Which hypothesis explains the residual: linear screening, candidate fits, validation on held-out runs."""
