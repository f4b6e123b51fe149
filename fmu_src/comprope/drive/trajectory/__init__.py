"""The position reference of the servo: S-curves, free curves, smoothing and input shaping."""
