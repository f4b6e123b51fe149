"""A reduced-order model of rope, sheave and hoist, fast enough for searches."""
