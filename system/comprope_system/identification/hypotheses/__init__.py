"""What may be missing from the model: effects, instrument errors, plant parameters with priors."""
