"""Effects of a user's own that tests name in models: always these files in this order, so that they are compiled once."""

from pathlib import Path

SPRING = Path(__file__).parent / "pit_spring.py"
EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
FILES = {"own_effects": [str(EXAMPLES / "rail_joints.py"), str(EXAMPLES / "pit_brush.py"), str(SPRING)]}
