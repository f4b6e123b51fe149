"""Weighted nonlinear least squares with priors, and model scores."""
