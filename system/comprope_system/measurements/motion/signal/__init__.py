"""A position signal before its motion is recovered: noise, resolution, spikes, held values."""
