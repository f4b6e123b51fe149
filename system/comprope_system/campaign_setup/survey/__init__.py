"""What raw logger files hold: runs, the motion of the car, and further columns."""
