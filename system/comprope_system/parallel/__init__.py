"""Executors and sweeps: many simulations in parallel, in processes or on a Dask cluster."""
