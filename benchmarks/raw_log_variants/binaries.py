"""Files of other programs."""

from collections.abc import Iterator
from datetime import timedelta
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from .variant import START, Variant, Write, write_bytes


def binaries(table: pd.DataFrame) -> Iterator[Variant]:
    """Files of other programs."""
    yield Variant("Excel with lines above", "run.xlsx", partial(_excel, table))
    stamped = table.assign(time=[START + timedelta(seconds=float(one)) for one in table["time"]])
    yield Variant("Excel with dates", "run.xlsx", partial(_excel, stamped))
    texts = table.map(lambda one: "" if pd.isna(one) else f"{one}".replace(".", ","))
    yield Variant("Excel with decimal commas as text", "run.xlsx", partial(_excel, texts))
    yield Variant("MATLAB structure", "run.mat", partial(_mat, {"run": {name: table[name].to_numpy() for name in table}}))
    arrays = {name: table[name].to_numpy() for name in table.columns[1:]}
    yield Variant("MATLAB without time, with fs", "run.mat", partial(_mat, {"fs": 25.0} | arrays))
    yield Variant("HDF5 compound", "run.h5", partial(_hdf5_compound, table))
    yield Variant("HDF5 matrix with names", "run.h5", partial(_hdf5_matrix, table))
    yield Variant("MATLAB 7.3", "run.mat", partial(_mat73, table))
    yield Variant("Parquet with time stamps", "run.parquet", lambda path: stamped.to_parquet(path))
    zoned = stamped.assign(time=pd.DatetimeIndex(stamped["time"]).tz_localize("Europe/Zurich"))
    yield Variant("Parquet with a time zone", "run.parquet", lambda path: zoned.to_parquet(path))
    yield Variant("MATLAB structure of Simulink", "run.mat", partial(_simulink, table))
    others = ", ".join(f'{name} = "{name}/values"' for name in table.columns[2:])
    groups = f'columns = {{ car = "car_position/values", {others} }}'
    yield Variant("HDF5 with a time in each group", "run.h5", partial(_hdf5_groups, table), run_extra=groups)
    yield Variant("TDMS waveforms", "run.tdms", partial(_tdms, table))
    yield Variant("a torn Parquet file", "run.parquet", partial(_torn, lambda path: table.to_parquet(path)))
    yield Variant("a torn Excel file", "run.xlsx", partial(_torn, partial(_excel, table)))
    yield Variant("a picture", "run.csv", lambda path: write_bytes(path, b"\x89PNG\r\n\x1a\n" + bytes(200)))
    yield Variant("an empty file", "run.csv", lambda path: write_bytes(path, b""))
    yield Variant("random bytes", "run.csv", lambda path: write_bytes(path, np.random.default_rng(1).bytes(5000)))


def _excel(table: pd.DataFrame, path: Path) -> None:
    table.to_excel(path, index=False, startrow=4)


def _mat(content: dict[str, object], path: Path) -> None:
    import scipy.io

    scipy.io.savemat(path, content)


def _hdf5_compound(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("run/table", data=table.to_records(index=False))


def _hdf5_matrix(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("data", data=table.to_numpy()).attrs["columns"] = list(table.columns)


def _hdf5_groups(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name in table.columns[1:]:
            file.create_dataset(f"{name}/time", data=table["time"].to_numpy())
            file.create_dataset(f"{name}/values", data=table[name].to_numpy())


def _simulink(table: pd.DataFrame, path: Path) -> None:
    signals = np.zeros(len(table.columns) - 1, dtype=[("values", "O"), ("label", "O")])
    for k, name in enumerate(table.columns[1:]):
        signals[k] = (table[name].to_numpy()[:, None], name)
    _mat({"out": {"time": table["time"].to_numpy(), "signals": signals}}, path)


def _mat73(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name in table:
            file.create_dataset(name, data=table[name].to_numpy()[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    data = bytearray(path.read_bytes())
    data[:19] = b"MATLAB 7.3 MAT-file"
    path.write_bytes(bytes(data))


def _tdms(table: pd.DataFrame, path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    properties = {"wf_increment": 0.04, "wf_start_offset": 0.0}
    channels = [ChannelObject("Run", name, table[name].to_numpy(), properties) for name in table.columns[1:]]
    with TdmsWriter(path) as writer:
        writer.write_segment(channels)


def _torn(write: Write, path: Path) -> None:
    write(path)
    path.write_bytes(path.read_bytes()[:-2000])
