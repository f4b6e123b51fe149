"""Table `[building]` of a model file: a record of the building's motion, and how it moves each height."""

from typing import Literal

from pydantic import Field, model_validator

from ...quantities import Component
from ...quantities import quantity as number


class Building(Component):
    """Lateral motion of the building, towards the counterweight's side positive.

    Without `shapes` each column is the motion at the height of the same place in `heights`; with them column k moves the heights
    in proportion to row k of `shapes`, and the columns add up.
    """

    record: str = Field(description="file with the record, relative to the model file: a table with a column of times")
    columns: tuple[str, ...] = Field(description='columns of the record that move the building, such as ["ground", "top"]')
    heights: tuple[float, ...] = Field(description="rising heights [m] above the bottom landing, from sheave to top landing")
    shapes: tuple[tuple[float, ...], ...] = Field(
        default=(), description="one row for each column: what it moves each height by; without, each column belongs to a height"
    )
    quantity: Literal["displacement", "acceleration"] = Field(
        default="displacement", description="what the columns hold, displacement or acceleration"
    )
    unit: str | None = Field(default=None, description='unit of the columns, such as "mm" or "m/s2", if the file states none')
    start: float = number(
        "s", "time [s] of the record, from its first sample, at which the simulation begins", 0.0, 1e6, default=0.0
    )
    fade_in: float = number("s", "time [s] from there over which the motion grows from nothing", 0.0, 1e4, default=0.0)

    @model_validator(mode="after")
    def _sensible(self) -> "Building":
        rising = all(low < high for low, high in zip(self.heights, self.heights[1:], strict=False))
        if len(self.heights) < 2 or not rising:
            raise ValueError(f"heights = {list(self.heights)}: two or more rising heights are accepted")
        if not self.columns or len(set(self.columns)) < len(self.columns):
            raise ValueError(f"columns = {list(self.columns)}: one or more different columns are accepted")
        if not self.shapes and len(self.columns) != len(self.heights):
            raise ValueError(
                f"{len(self.columns)} columns for {len(self.heights)} heights: one column for each height is accepted, or shapes"
            )
        if self.shapes and (len(self.shapes) != len(self.columns) or {len(row) for row in self.shapes} != {len(self.heights)}):
            raise ValueError(
                f"shapes of {len(self.shapes)} rows with {sorted({len(row) for row in self.shapes})} values: a row for each of "
                f"{len(self.columns)} columns with a value for each of {len(self.heights)} heights is accepted"
            )
        return self
