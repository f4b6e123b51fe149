"""How the files of a campaign are written, as far as that is stated: the table `[file]` of campaign.toml."""

from typing import Literal

from pydantic import Field

from comprope.quantities import Component


class FileFormat(Component):
    """How the run files are written. Every key is optional: what is absent is found from the file itself."""

    encoding: str | None = Field(default=None, description='of a text file, e.g. "utf-8", "utf-16", "latin-1"')
    separator: str | None = Field(
        default=None, description='between the cells of a text file, e.g. ";" or "\\t"; " " for any blanks'
    )
    decimal: Literal[".", ","] | None = Field(default=None, description="decimal sign of a text file")
    header: int | None = Field(default=None, ge=1, description="line of a text file or sheet that holds the column names, from 1")
    sheet: str | None = Field(
        default=None, description="sheet of a workbook, group of an HDF5, MAT, TDMS or MDF file, or file in a ZIP archive"
    )
    time: str | None = Field(default=None, description="the column of time, if it is not recognised by its name")
    time_unit: str | None = Field(
        default=None, description="unit of numeric times: s, ms, us, ns, min, h, d, or sample with a rate"
    )
    rate: float | None = Field(
        default=None, gt=0.0, description="samples per second [Hz], where the time column counts samples or is absent"
    )
    missing: tuple[float | int | str, ...] = Field(
        default=(), description='numbers and words that stand for no value, e.g. [9999, "OVL"]'
    )
    ignore_units: bool = Field(
        default=False, description="true: units written in the files are ignored; those of campaign.toml hold"
    )
