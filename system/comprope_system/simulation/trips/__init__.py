"""One trip of drive and rope: simulation, results, plots and animation."""
