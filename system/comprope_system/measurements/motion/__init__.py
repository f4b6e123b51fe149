"""The motion of car and counterweight, recovered from positions, speeds or accelerations."""
