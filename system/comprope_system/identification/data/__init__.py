"""Measurement campaigns: files, trip phases, whitened channels."""
