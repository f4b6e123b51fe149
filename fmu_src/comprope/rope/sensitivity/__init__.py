"""Directional derivatives; each file is named as the one in mechanics/ or integration/ that it differentiates."""
