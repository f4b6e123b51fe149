"""The model against measurements: error metrics, clock offsets, data quality."""
