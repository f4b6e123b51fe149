"""One trip of drive and rope: simulation, results, picture and animation."""
