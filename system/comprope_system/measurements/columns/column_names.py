"""Which column of a file is meant: by its exact name, without its unit, or by what loggers call time and car position."""

import re
from collections.abc import Sequence

from comprope.errors import InputError

from ..files.raw_table import RawColumn, RawTable, printable
from ..units import split_unit

TIME_NAMES = frozenset(
    [
        "time", "t", "timestamp", "time_stamp", "datetime", "date_time", "date/time", "date&time", "zeit", "zeitstempel",
        "uhrzeit",
        "temps", "tempo", "x_value", "xvalue", "elapsed", "elapsed_time", "relative_time", "rel_time", "time_rel", "timer",
        "clock", "utc", "sec", "secs", "seconds", "ms", "milliseconds",
    ]
)
CAR_NAMES = {
    "position": "car_position car_pos car_height carposition cabin_position cab_position kabinenposition kabine_position "
    "car_z z_car position_car fahrkorb_position fahrkorbposition car_encoder encoder car car_level cabin_height cab_height "
    "kabinenhöhe fahrkorbhöhe lift_position lift_height elevator_position elevator_height cage_position position_cabine",
    "speed": "car_speed car_velocity car_v v_car cabin_speed cabin_velocity carspeed carvelocity fahrkorbgeschwindigkeit car_vel "
    "kabinengeschwindigkeit lift_speed elevator_speed elevator_velocity",
    "acceleration": "car_acceleration car_accel car_acc a_car car_a cabin_acceleration caracceleration fahrkorbbeschleunigung "
    "kabinenbeschleunigung lift_acceleration elevator_acceleration",
}
COUNTERWEIGHT_NAMES = {
    "position": "counterweight_position counterweight_pos cw_position cwt_position counterweight_height gegengewicht_position",
    "speed": "counterweight_speed counterweight_velocity cw_speed cw_velocity cwt_speed gegengewichtgeschwindigkeit",
    "acceleration": "counterweight_acceleration cw_acceleration cwt_acceleration gegengewichtbeschleunigung",
}
RATES = {  # parts of names
    "acceleration": re.compile(r"accel|beschl|(^|_)acc(_|$)|(^|_)a(_|$)"),
    "speed": re.compile(r"speed|veloc|geschw|tacho|(^|_)vel(_|$)|(^|_)v(_|$)"),
}


def plain_name(name: str) -> str:
    """A name for comparison: without unit, in lower case, one underscore for every other separator."""
    return re.sub(r"[\s_\-.]+", "_", split_unit(name)[0].strip().lower()).strip("_")


def find_column(table: RawTable, name: str) -> RawColumn:
    """The column of this name: exactly, or the only one that differs in unit, case and separators alone.

    Raises `InputError`, without the file's name, which lists the columns.
    """
    exact = [one for one in table.columns if one.name == name.strip()]
    same = exact or named_one_of(table, [plain_name(name)])
    if len(same) == 1 and not (exact and _is_repeated(table, name)):
        return same[0]
    names = ", ".join(one.name for one in table.columns)
    if not same:
        raise InputError(f"no column {printable(name)}; the header has {printable(names, 300)}")
    raise InputError(f"column {printable(name)}: several columns have this name; the header has {printable(names, 300)}")


def _is_repeated(table: RawTable, name: str) -> bool:
    return any(one.name == f"{name} (2)" for one in table.columns)


def named_one_of(table: RawTable, names: Sequence[str]) -> list[RawColumn]:
    """The columns whose plain names are among `names`, or, where there are none, those with such an alias."""
    found = [one for one in table.columns if plain_name(one.name) in names]
    return found or [one for one in table.columns if any(plain_name(alias) in names for alias in one.aliases)]


def is_time_name(name: str) -> bool:
    """Whether a column of this name holds times: "Time [s]", "t", "time_lasers", "Zeit 2"."""
    plain = plain_name(re.sub(r"\s*\(\d+\)$", "", name).rpartition("/")[2] or name)
    first = plain.split("_")[0]
    return plain in TIME_NAMES or first in ("time", "zeit", "timestamp", "t") or plain.endswith(("_time", "_zeit", "_timestamp"))


def quantity_named(name: str) -> str:
    """What a column of a motion holds, by its name: "position", "speed" or "acceleration"."""
    plain = plain_name(name)
    known = next((q for names in (CAR_NAMES, COUNTERWEIGHT_NAMES) for q, one in names.items() if plain in one.split()), None)
    return known or next((quantity for quantity, pattern in RATES.items() if pattern.search(plain)), "position")


def car_column(table: RawTable, names: dict[str, str] = CAR_NAMES) -> tuple[RawColumn, str] | None:
    """The column of the car's motion and its quantity, position first; None if no name is one of a car's motion.

    Raises `InputError`, without the file's name, if several columns could be meant.
    """
    for quantity, known in names.items():
        for name in known.split():
            found = named_one_of(table, [name])
            if len(found) > 1:
                raise InputError(
                    f"several columns may be the car's {quantity}: {', '.join(one.name for one in found)}; "
                    'write column = "..." under [car]'
                )
            if found:
                return found[0], quantity
    return None
