"""A campaign from raw logger files: what each column is, its unit, sign and noise, and the role of each run."""
