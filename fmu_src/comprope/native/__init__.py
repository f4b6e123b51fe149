"""The rope as an FMU without Python: its kernels compiled ahead of time, behind a face in C."""
