"""Synthetic Dataport files with the documented header, in every form they are met in."""

from datetime import datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np
import pytest

from hemma.data import PecanStreetOptions, TimeOfUse, read_pecan_street
from hemma.errors import HemmaError

HEADER = """
dataid,local_15min,air1,air2,air3,airwindowunit1,aquarium1,bathroom1,bathroom2,bedroom1,bedroom2,
bedroom3,bedroom4,bedroom5,battery1,car1,car2,circpump1,clotheswasher1,clotheswasher_dryg1,
diningroom1,diningroom2,dishwasher1,disposal1,drye1,dryg1,freezer1,furnace1,furnace2,garage1,
garage2,grid,heater1,heater2,heater3,housefan1,icemaker1,jacuzzi1,kitchen1,kitchen2,kitchenapp1,
kitchenapp2,lights_plugs1,lights_plugs2,lights_plugs3,lights_plugs4,lights_plugs5,lights_plugs6,
livingroom1,livingroom2,microwave1,office1,outsidelights_plugs1,outsidelights_plugs2,oven1,oven2,
pool1,pool2,poollight1,poolpump1,pump1,range1,refrigerator1,refrigerator2,security1,sewerpump1,
shed1,solar,solar2,sprinkler1,sumppump1,utilityroom1,venthood1,waterheater1,waterheater2,wellpump1,
winecooler1,leg1v,leg2v
""".replace("\n", "").split(",")
CENTRAL = ZoneInfo("US/Central")
TARIFF = TimeOfUse(0.1, 0.2)
QUARTER = timedelta(minutes=15)


def instants(count, first="2018-06-01T05:00+00:00", step=QUARTER):
    return [datetime.fromisoformat(first) + k * step for k in range(count)]


def dataport(instant):
    """``2018-06-01 00:00:00-05``, Dataport's own form."""
    return instant.astimezone(CENTRAL).strftime("%Y-%m-%d %H:%M:%S%z")[:-2]


def naive(instant):
    return instant.astimezone(CENTRAL).strftime("%Y-%m-%d %H:%M:%S")


def excel(instant):
    return instant.astimezone(CENTRAL).strftime("%d/%m/%Y %H:%M")


def circuits(k):
    """A home with PV by day, an air conditioner in two circuits and 0.5 to 0.8 kW of other load."""
    solar = max(0.0, 3.0 - abs(k % 96 - 50) / 8)
    hvac = {"air1": 1.2 * (k % 3 == 0), "furnace1": 0.1}
    load = 0.5 + 0.1 * (k % 4)
    return {"solar": solar, "grid": load + sum(hvac.values()) - solar, **hvac}


def row(home, stamp, values, header=HEADER, separator=","):
    cells = {"dataid": home, header[1]: stamp, "leg1v": 123.9, "leg2v": 124.2, **values}
    return separator.join(str(cells.get(column, "")) for column in header)


def body(count, form=dataport, home=661, **changed):
    rows = []
    for k, instant in enumerate(instants(count)):
        values = circuits(k)
        for name, change in changed.items():
            values[name] = change(k, values)
        rows.append(row(home, form(instant), values))
    return rows


def expected(count, name, per_slot=4):
    k = np.arange(count)
    series = {
        "pv": np.maximum(0.0, 3.0 - np.abs(k % 96 - 50) / 8),
        "load": 0.5 + 0.1 * (k % 4),
        "hvac": 1.2 * (k % 3 == 0) + 0.1,
    }[name]
    return series.reshape(-1, per_slot).mean(axis=1)


def weather_file(folder, first, hours):
    lines = [f"{t.isoformat()},25" for t in instants(hours, first, timedelta(hours=1))]
    (folder / "year.csv").write_text("\n".join(["time,outdoor_c", *lines]))
    return folder / "year.csv"


def bad_cell(rows, k, text):
    cells = rows[k].split(",")
    cells[HEADER.index("solar")] = text
    return [*rows[:k], ",".join(cells), *rows[k + 1 :]]


def read(folder, rows, options=None, header=HEADER, separator=",", **given):
    path = folder / "15minute_data_austin.csv"
    path.write_text("\n".join([separator.join(header), *rows]) + "\n")
    given = {"weather": folder / "weather.csv", "prices": TARIFF, **given}
    return read_pecan_street(path, 661, options=options or PecanStreetOptions(), **given)


def refusal(*arguments, **named):
    with pytest.raises(HemmaError) as caught:
        read(*arguments, **named)
    return str(caught.value)


def same_series(one, other):
    assert one.time_stamps() == other.time_stamps()
    for a, b in (
        (one.exogenous.pv_generation, other.exogenous.pv_generation),
        (one.exogenous.load, other.exogenous.load),
        (one.hvac_power, other.hvac_power),
    ):
        np.testing.assert_allclose(a, b, atol=1e-12)
