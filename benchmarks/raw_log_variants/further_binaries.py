"""Further files of other programs: scaled whole numbers, times as attributes or index, several sheets, names that mislead."""

from collections.abc import Iterator
from datetime import datetime, timedelta
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
import pandas as pd

from .variant import START, Variant, csv, write_bytes


def further_binaries(table: pd.DataFrame) -> Iterator[Variant]:
    """All variants of this file."""
    yield Variant("netCDF with scaled whole numbers", "run.nc", partial(_netcdf, table))
    yield Variant("HDF5 with times as attributes", "run.h5", partial(_hdf5_waveforms, table))
    stamped = table.drop(columns="time").set_axis(
        pd.DatetimeIndex([START + timedelta(seconds=float(one)) for one in table["time"]], name=None)
    )
    yield Variant("Parquet with the time as index", "run.parquet", lambda path: stamped.to_parquet(path))
    spans = table.assign(time=pd.to_timedelta(table["time"], unit="s"))
    yield Variant("Parquet with durations", "run.parquet", lambda path: spans.to_parquet(path))
    single = table.astype("float32").astype(float)
    yield Variant("Parquet in single precision", "run.parquet", partial(_parquet_single, single), truth=single)
    yield Variant("Excel with a sheet of notes first", "run.xlsx", partial(_two_sheets, table))
    yield Variant("Excel with formulas", "run.xlsx", partial(_formulas, table))
    yield Variant("Excel with times of day", "run.xlsx", partial(_times_of_day, table))
    yield Variant("a CSV file named .xlsx", "run.xlsx", lambda path: write_bytes(path, csv(table).encode()))
    yield Variant("tabs named .xls", "run.xls", lambda path: write_bytes(path, csv(table, sep="\t").encode()))
    yield Variant("MATLAB structures for each channel", "run.mat", partial(_mat_channels, table))
    yield Variant("MATLAB columns of names and a matrix", "run.mat", partial(_mat_matrix, table))
    yield Variant("MATLAB in single precision", "run.mat", partial(_mat_single, table), truth=single)
    yield Variant("TDMS with channels of other lengths", "run.tdms", partial(_tdms_lengths, table), truth=_shortened(table))
    yield Variant("arrays of NumPy", "run.npz", lambda path: np.savez(path, **{name: table[name] for name in table}))
    yield Variant("a pickle", "run.pkl", lambda path: table.to_pickle(path))
    yield Variant("Feather", "run.feather", lambda path: table.to_feather(path))
    yield Variant("a sound", "run.wav", lambda path: write_bytes(path, b"RIFF" + bytes(40) + b"WAVEfmt " + bytes(5000)))


def _netcdf(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("time", data=table["time"].to_numpy())
        for name, scale in ((name, 1e-4) for name in table.columns[1:]):
            whole = np.where(table[name].isna(), -32768, np.round(table[name].fillna(0.0) / scale)).astype("i4")
            stored = file.create_dataset(name, data=whole)
            stored.attrs["scale_factor"], stored.attrs["add_offset"], stored.attrs["_FillValue"] = scale, 0.0, np.int32(-32768)


def _hdf5_waveforms(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name in table.columns[1:]:
            file.create_dataset(name, data=table[name].to_numpy()).attrs["dt"] = 0.04


def _parquet_single(table: pd.DataFrame, path: Path) -> None:
    table.astype("float32").to_parquet(path)


def _two_sheets(table: pd.DataFrame, path: Path) -> None:
    with pd.ExcelWriter(path) as writer:
        pd.DataFrame({"Setup": ["Logger", "Operator"], "Value": ["X", "Max"]}).to_excel(writer, sheet_name="Info", index=False)
        table.to_excel(writer, sheet_name="Data", index=False)


def _formulas(table: pd.DataFrame, path: Path) -> None:
    import openpyxl

    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(list(table.columns))
    for row in table.fillna(0.0).itertuples(index=False):
        sheet.append([*row[:2], f"={row[2]}*1", *row[3:]])
    book.save(path)


def _times_of_day(table: pd.DataFrame, path: Path) -> None:
    stamps = [(START + timedelta(seconds=float(one))).time() for one in table["time"]]
    table.assign(time=stamps).to_excel(path, index=False)


def _mat_channels(table: pd.DataFrame, path: Path) -> None:
    import scipy.io

    time = table["time"].to_numpy()
    scipy.io.savemat(path, {name: {"time": time, "values": table[name].to_numpy()} for name in table.columns[1:]})


def _mat_matrix(table: pd.DataFrame, path: Path) -> None:
    import scipy.io

    scipy.io.savemat(path, {"data": table.to_numpy(), "names": np.array(list(table.columns), dtype=object)})


def _mat_single(table: pd.DataFrame, path: Path) -> None:
    import scipy.io

    scipy.io.savemat(path, {name: table[name].to_numpy(dtype="float32") for name in table})


def _tdms_lengths(table: pd.DataFrame, path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    properties = {"wf_increment": 0.04, "wf_start_offset": 0.0, "wf_start_time": datetime(2026, 11, 2)}
    columns = enumerate(table.columns[1:])
    channels = [ChannelObject("Run", name, table[name].to_numpy()[: len(table) - k], properties) for k, name in columns]
    data = BytesIO()
    with TdmsWriter(data) as writer:
        writer.write_segment(channels)
    path.write_bytes(data.getvalue())


def _shortened(table: pd.DataFrame) -> pd.DataFrame:
    """The table without the last samples of each channel: one fewer than of the channel before."""
    found = table[: len(table) - 1].copy()
    for k, name in enumerate(table.columns[2:]):
        found.loc[found.index >= len(found) - k, name] = np.nan
    return found
