"""Verification of the numerics: another program, closed-form solutions, symmetry, conservation. One check per module."""
