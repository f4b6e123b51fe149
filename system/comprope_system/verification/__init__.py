"""Checks of the numerics: against another program, closed forms, symmetry and conservation. One check a module."""
