"""What uses the rope and the drive: co-simulation, comparison with measurements, diagnosis, reports."""
