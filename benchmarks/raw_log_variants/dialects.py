"""Text tables in other dialects and encodings."""

from collections.abc import Iterator

import pandas as pd

from .variant import Variant, csv, inserted, text

LABVIEW = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\t{columns}\nDate\t2026/11/02\n"
    "Time\t09:12:01,123\n***End_of_Header***\t\n\t\nChannels\t6\nSamples\t826{gap}826{gap}826{gap}826{gap}826{gap}826\n"
    "X0\t0,0E+0{gap}0,0E+0\nDelta_X\t0,04{gap}0,04{gap}0,04{gap}0,04{gap}0,04{gap}0,04\n***End_of_Header***\n"
)


def separators(table: pd.DataFrame) -> Iterator[Variant]:
    """Separators, decimal signs, quotation marks and line ends."""
    plain = csv(table)
    lines = plain.splitlines()
    comma = csv(table, sep=";", decimal=",")
    for name, sep, decimal in (
        ("semicolon, decimal point", ";", "."), ("tab, decimal comma", "\t", ","), ("bar", "|", "."),
        ("bar, decimal comma", "|", ","),
    ):  # fmt: skip
        yield text(name, csv(table, sep=sep, decimal=decimal))
    filled = table.fillna(-9999.0)
    yield text("blanks", filled.to_string(index=False))
    yield text("blanks, decimal comma", filled.to_string(index=False).replace(".", ","))
    named = "time [s]  car position [m]  cw low  cw mid  car low  sheave dx  sheave w\n"
    yield text("blanks, in names too", named + filled.to_string(index=False, header=False))
    yield text("all cells quoted", csv(table, quoting=1))
    texts = table.map(lambda one: "" if pd.isna(one) else f"{one}".replace(".", ","))
    yield text("quoted decimal commas between commas", csv(texts, quoting=1))
    yield text("decimal commas between commas, unquoted", comma.replace(";", ","))
    yield text("CRLF", plain.replace("\n", "\r\n"))
    yield text("CR", plain.replace("\n", "\r"))
    yield text("a delimiter at the end of each line", plain.replace("\n", ",\n"))
    ended = [f"{one},\n" for one in lines[1:]]
    yield text("a delimiter at the end of each row but not of the header", lines[0] + "\n" + "".join(ended))
    yield text("a blank line between rows", plain.replace("\n", "\n\n"))
    yield text("blanks after commas", plain.replace(",", ",  "))
    yield text("line sep=;", "sep=;\n" + comma)
    thousands = table.assign(car_position=[f"{1e3 * x:,.1f}" for x in table["car_position"]]).rename(
        columns={"car_position": "car_position [mm]"}
    )
    yield text("thousands separated", csv(thousands, sep=";"))
    yield text("exponents", csv(table, float_format="%.9e"))
    yield text("exponents with D", csv(table, float_format="%.9e").replace("e-", "D-").replace("e+", "D+"))
    yield text("minus signs of typography", plain.replace("-", "−"))


def lines_around(table: pd.DataFrame) -> Iterator[Variant]:
    """Lines above, within and below the table."""
    plain = csv(table)
    lines = plain.splitlines()
    comma = csv(table, sep=";", decimal=",")
    yield text("header in a comment", "# " + plain)
    yield text("comments above and within", "% logger 7\n% 2 Nov\n" + "\n".join([*lines[:300], "# marker pressed", *lines[300:]]))
    yield text("no header", "\n".join(lines[1:]))
    stated = [f'{name} = "column {k}"' for k, name in enumerate(table.columns, 1) if name not in ("time", "car_position")]
    run = f'columns = {{ car = "column 2", {", ".join(stated)} }}'
    yield text("no header, columns stated", "\n".join(lines[1:]), '[file]\ntime = "column 1"\n', run)
    yield text("header repeated", "\n".join([*lines[:400], lines[0], *lines[400:]]))
    head = [lines[0], "s,m,mm,mm,mm,mm,rad/s"]
    yield text("header and units repeated", "\n".join([*head, *lines[1:400], *head, *lines[400:]]))
    yield text("footer", plain + "\nEnd of file\nchecksum 7f3a\n")
    yield text("footer of statistics", plain + "Mean,1.0,2.0,3.0,4.0,5.0,6.0\nMax,1.0,2.0,3.0,4.0,5.0,6.0\n")
    yield text("last line torn", plain.rstrip("\n")[:-12])
    yield text("nine lines above", "Logger;X\nSerial;123\nSetup;A;B;C\nOperator;Max\n\nChannels;7\nNote;a;b\n\nRate;25\n" + comma)
    yield text("numbers in the lines above", "Gain,1,1,1,1,1,1\nLimits,-50,50,-20,20,0,1\n" + plain)
    yield text("a cell with a word", plain.replace(lines[200], lines[200].replace(lines[200].split(",")[2], "0.1b", 1)))
    yield text("a row with a cell too many", "\n".join([*lines[:300], lines[300] + ",7.0", *lines[301:]]))


def columns(table: pd.DataFrame) -> Iterator[Variant]:
    """Further columns, other names and another order."""
    plain = csv(table)
    lines = plain.splitlines()
    yield text("a text column first", "\n".join(["status," + lines[0], *("OK," + one for one in lines[1:])]))
    yield text("row numbers first", "\n".join(["no," + lines[0], *(f"{k}," + one for k, one in enumerate(lines[1:], 1))]))
    yield text("a text column amid, sometimes empty", csv(inserted(table, 3, "event", ["start"] + [""] * (len(table) - 1))))
    yield text("a constant column named time", csv(inserted(table, 2, "response_time", 7.0)))
    yield text("two lines of names", "\n".join(["t,car,laser,laser,laser,sheave,sheave", *lines]))
    yield text("an empty column at the end", csv(table.assign(spare="")))
    yield text("columns in another order", csv(table[[*table.columns[::-1]]]))
    yield text("names in capitals with blanks", csv(table.rename(columns=lambda name: name.upper().replace("_", " "))))
    yield text("a column twice", csv(inserted(table, 4, "cw_low", table["cw_mid"].to_numpy(), allow_duplicates=True)))
    yield text("escape characters in a name", plain.replace("cw_low", "cw_low\x1b[31m", 1))


def labview(table: pd.DataFrame) -> Iterator[Variant]:
    """LabVIEW measurement files with a time beside each channel, and without times."""
    cells = table.map(lambda one: "" if pd.isna(one) else f"{one}".replace(".", ","))
    names = [*table.columns[1:]]
    rows = ["\t".join(f"{row[0]}\t{one}" for one in row[1:]) for row in cells.itertuples(index=False)]
    head = LABVIEW.format(columns="Multi", gap="\t\t") + "\t".join(f"X_Value\t{one}" for one in names)
    yield text("LabVIEW, times beside each channel", "\n".join([f"{head}\tComment", *rows]), file="run.lvm")
    rows = ["\t".join(["", *row[1:]]) for row in cells.itertuples(index=False)]
    head = LABVIEW.format(columns="No", gap="\t") + "\t".join(["X_Value", *names])
    yield text("LabVIEW without times", "\n".join([f"{head}\tComment", *rows]), file="run.lvm")


def encodings(table: pd.DataFrame) -> Iterator[Variant]:
    """Encodings, with a spare column whose name needs them."""
    plain = csv(table.assign(**{"Größe [°C]": 20.5}))
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1", "cp1252", "utf-32"):
        yield text(f"encoding {encoding}", plain.encode(encoding))
    yield text("encoding cp437, stated", plain.encode("cp437"), '[file]\nencoding = "cp437"\n')
