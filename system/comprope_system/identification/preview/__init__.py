"""Previews of effects: what the model would predict at other parameters, interpolated between a few replays."""
