"""Identification as result objects: comparison, diagnosis, model updating, with their sentences, tables, figures and pages."""
