"""Binary files of test benches, MATLAB and spreadsheets: dSPACE, timetables, groups of other rates, marked samples."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from .automation import stamps_of
from .loggers import UNITS
from .variant import Variant


def benches(table: pd.DataFrame) -> Iterator[Variant]:
    """Binary files of benches and of MATLAB."""
    yield Variant("dSPACE structure", "run.mat", partial(_dspace, table))
    yield Variant("Simulink matrix in rows", "run.mat", partial(_rows, table))
    yield Variant("a pair of times and values for each channel", "run.mat", partial(_pairs, table))
    yield Variant("MATLAB timetable of version 7.3", "run.mat", partial(_timetable, table))
    yield Variant("TDMS with a channel of times", "run.tdms", partial(_tdms_stamps, table))
    yield Variant("TDMS with groups of other rates", "run.tdms", partial(_tdms_groups, table))
    yield Variant("MDF 3", "run.mdf", partial(_mdf, table, "3.30"))
    yield Variant("MDF 4 with scaled whole numbers", "run.mf4", partial(_mdf_scaled, table))
    yield Variant("MDF 4 with groups of other rates", "run.mf4", partial(_mdf_groups, table))
    yield Variant("Excel with a sheet for each channel", "run.xlsx", partial(_sheets, table))
    yield Variant("Excel with a hidden sheet", "run.xlsx", partial(_hidden, table))
    yield Variant("Excel with a chart sheet and title rows", "run.xlsx", partial(_titled, table))
    yield Variant("Excel, dates since 1904", "run.xlsx", partial(_since_1904, table))
    yield Variant("HDF5 of pandas", "run.h5", partial(_pandas_h5, table))
    yield Variant("OpenDocument", "run.ods", partial(_ods, table))


def _dspace(table: pd.DataFrame, path: Path) -> None:
    import scipy.io

    x = {"Name": "time", "Data": table["time"].to_numpy()[None, :], "Unit": "s"}
    kinds = [("Name", object), ("Data", object), ("Unit", object)]
    y = np.array(
        [(name, table[name].to_numpy()[None, :], unit) for name, unit in zip(table.columns[1:], UNITS[1:], strict=True)],
        dtype=kinds,
    )
    scipy.io.savemat(path, {"run": {"X": x, "Y": y[None, :], "Description": {"General": "x"}}})


def _rows(table: pd.DataFrame, path: Path) -> None:
    import scipy.io

    scipy.io.savemat(path, {"ans": table.to_numpy().T})


def _pairs(table: pd.DataFrame, path: Path) -> None:
    import scipy.io

    scipy.io.savemat(path, {name: table[["time", name]].to_numpy() for name in table.columns[1:]})


def _timetable(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        run = file.create_dataset("run", data=np.array([[3707764736, 2, 1, 1, 1, 1]], dtype="u4"))
        run.attrs["MATLAB_class"], run.attrs["MATLAB_object_decode"] = np.bytes_("timetable"), np.int32(3)
        group = file.create_group("#refs#")
        for k, name in enumerate(table):
            group.create_dataset(f"r{k}", data=table[name].to_numpy())
        file.create_group("#subsystem#").create_dataset("MCOS", data=np.zeros((1, 5), "u4"))


def _tdms_stamps(table: pd.DataFrame, path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    stamps = np.array([np.datetime64(one) for one in stamps_of(table)], dtype="datetime64[us]")
    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("Run", "Timestamp", stamps),
                *[ChannelObject("Run", name, table[name].to_numpy()) for name in table.columns[1:]],
            ]
        )


def _tdms_groups(table: pd.DataFrame, path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as writer:
        writer.write_segment(
            [
                ChannelObject("Drive", "time", table["time"].to_numpy()),
                ChannelObject("Drive", "car_position", table["car_position"].to_numpy()),
                ChannelObject("Lasers", "time", table["time"].to_numpy()),
                *[ChannelObject("Lasers", name, table[name].to_numpy()) for name in table.columns[2:]],
            ]
        )


def _signals(table: pd.DataFrame) -> list[object]:
    from asammdf import Signal

    return [
        Signal(table[name].to_numpy(), table["time"].to_numpy(), name=name, unit=unit)
        for name, unit in zip(table.columns[1:], UNITS[1:], strict=True)
    ]


def _mdf(table: pd.DataFrame, version: str, path: Path) -> None:
    from asammdf import MDF

    with MDF(version=version) as file:
        file.append(_signals(table))
        file.save(path, overwrite=True)


def _mdf_scaled(table: pd.DataFrame, path: Path) -> None:
    from asammdf import MDF, Signal

    found = []
    for name, unit in zip(table.columns[1:], UNITS[1:], strict=True):
        whole = np.round(table[name].fillna(0.0).to_numpy() * 1e4).astype("i4")
        found.append(
            Signal(
                whole,
                table["time"].to_numpy(),
                name=name,
                unit=unit,
                conversion={"a": 1e-4, "b": 0.0},
                invalidation_bits=table[name].isna().to_numpy(),
            )
        )
    with MDF(version="4.10") as file:
        file.append(found)
        file.save(path, overwrite=True)


def _mdf_groups(table: pd.DataFrame, path: Path) -> None:
    from asammdf import MDF

    with MDF(version="4.10") as file:
        for one in _signals(table):
            file.append([one])
        file.save(path, overwrite=True, compression=2)


def _sheets(table: pd.DataFrame, path: Path) -> None:
    with pd.ExcelWriter(path) as writer:
        for name in table.columns[1:]:
            table[["time", name]].to_excel(writer, sheet_name=name, index=False)


def _hidden(table: pd.DataFrame, path: Path) -> None:
    with pd.ExcelWriter(path) as writer:
        table.to_excel(writer, sheet_name="Data", index=False)
        (table * 2.0).to_excel(writer, sheet_name="Old", index=False)
        writer.sheets["Old"].sheet_state = "hidden"


def _titled(table: pd.DataFrame, path: Path) -> None:
    import openpyxl
    from openpyxl.chart import LineChart

    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["Measurement in the tower"])
    sheet.merge_cells("A1:G1")
    sheet.append([])
    sheet.append([None, "Drive", "Lasers", None, None, "Sheave", None])
    sheet.merge_cells("C3:E3")
    sheet.append(list(table.columns))
    sheet.append([f"[{one}]" for one in UNITS])
    for row in table.itertuples(index=False):
        sheet.append([None if one != one else one for one in row])
    book.create_chartsheet("Chart").add_chart(LineChart())
    book.save(path)


def _since_1904(table: pd.DataFrame, path: Path) -> None:
    import openpyxl
    from openpyxl.utils.datetime import CALENDAR_MAC_1904

    book = openpyxl.Workbook()
    book.epoch = CALENDAR_MAC_1904
    sheet = book.active
    sheet.append(list(table.columns))
    for one, row in zip(stamps_of(table), table.to_numpy(), strict=True):
        sheet.append([one, *(None if cell != cell else float(cell) for cell in row[1:])])
    book.save(path)


def _pandas_h5(table: pd.DataFrame, path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        group = file.create_group("run")
        for key in ("axis0", "block0_items"):
            group.create_dataset(key, data=np.array([one.encode() for one in table.columns]))
        group.create_dataset("axis1", data=np.arange(len(table)))
        group.create_dataset("block0_values", data=table.to_numpy())


def _ods(table: pd.DataFrame, path: Path) -> None:
    import zipfile

    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr("content.xml", "<office:document-content/>")
