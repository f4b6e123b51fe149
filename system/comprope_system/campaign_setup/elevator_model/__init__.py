"""The model of a new campaign: a file, a preset, a data sheet, or answers."""
