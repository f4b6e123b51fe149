"""What the model predicts for measured runs: its unknowns (plant parameters with priors, effects), replays, sensitivities."""
