"""The app: a page on this machine for the way from raw files to a better model, a thin user of the public functions."""
