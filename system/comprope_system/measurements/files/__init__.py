"""Files of any logger as one kind of table: text, spreadsheets, MATLAB, HDF5, Parquet, TDMS, MDF."""

from .raw_table import RawColumn, RawTable
from .reader import read_raw_table

__all__ = ["RawColumn", "RawTable", "read_raw_table"]
