"""The rope as an FMU without Python: its kernels compiled ahead of time, with the functions of the FMI in C."""
