"""What the model predicts for measured runs, and its parameter sensitivities."""
