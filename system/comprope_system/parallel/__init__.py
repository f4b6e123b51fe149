"""Executors and sweeps: many simulations side by side, in processes or on a Dask cluster."""
