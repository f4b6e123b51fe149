"""Spreadsheets and binary files, one module each."""
