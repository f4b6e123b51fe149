"""Parquet files."""

from pathlib import Path

import pyarrow.parquet

from ..file_format import FileFormat
from ..raw_table import RawColumn, RawTable, unique_names


def read(path: Path, stated: FileFormat) -> RawTable:
    """The table of the file; units from the metadata of its fields."""
    table = pyarrow.parquet.ParquetFile(path).read()
    columns = []
    for name, field in zip(unique_names(table.column_names), table.schema, strict=True):
        own = {
            key.decode(errors="replace").lower(): value.decode(errors="replace") for key, value in (field.metadata or {}).items()
        }
        columns.append(RawColumn(name, table.column(field.name).to_pandas(), own.get("unit") or own.get("units")))
    return RawTable(tuple(columns))
