"""The elevator drive: jerk-limited trips, a servo designed with python-control, and the hoist it moves."""
