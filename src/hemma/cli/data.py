"""``hemma data``: look at traces, and bring them into the canonical form."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hemma.cli.console import say
from hemma.cli.files import Force, path_argument, path_option, require_new

if TYPE_CHECKING:
    from hemma.data import TimeOfUse

app = typer.Typer(help="Look at traces and bring them into the canonical form.", no_args_is_help=True)

ENDINGS = (".csv", ".csv.gz")
Canonical = Annotated[Path, path_argument("FILE", "Canonical trace file, .csv or .csv.gz.", False)]
Dataport = Annotated[Path, path_argument("SOURCE", "Pecan Street Dataport file, .csv, .csv.gz or .tar.gz.")]


@app.command()
def check(file: Canonical) -> None:
    """Read a canonical trace file and say what it holds, what was repaired and what looks odd."""
    from hemma.data import read_canonical, report_quality

    for line in report_quality(read_canonical(file)):
        say(line)


@app.command()
def export(
    file: Canonical,
    home: Annotated[int, typer.Option("--home", help="Number of the embedded home, 1 to 6.")] = 1,
    force: Force = False,
) -> None:
    """Write an embedded home as a canonical trace file: an example to fill with your own numbers."""
    from hemma.data import load_austin2021, write_canonical

    require_new(file, force, ENDINGS)
    traces = load_austin2021(home)
    write_canonical(traces, file)
    say(f"{file}: {traces.slots} slots of {traces.name}. {traces.source}")


@app.command()
def list_pecan_street(
    source: Dataport,
    metadata: Annotated[Path | None, path_option("--metadata", "FILE", "Dataport's metadata.csv.")] = None,
) -> None:
    """Say which homes a Pecan Street Dataport file holds and what is instrumented in them."""
    from hemma.data import list_pecan_street_homes

    for home in list_pecan_street_homes(source, metadata):
        place = f", {home.city}" if home.city else ""
        say(f"{home.home}: {home.first} to {home.last}, {', '.join(home.circuits)}{place}")


def _prices(
    file: Path | None, off_peak: float | None, peak: float | None, hours: tuple[float, float]
) -> "Path | TimeOfUse":
    """Where the prices of a Pecan Street home come from: a file, or a time-of-use tariff."""
    from hemma.data import TimeOfUse
    from hemma.errors import HemmaError

    if file is not None and off_peak is None and peak is None:
        return file
    if file is not None or off_peak is None or peak is None:
        raise HemmaError("expected prices: either --prices FILE, or both --off-peak and --peak")
    return TimeOfUse(off_peak, peak, *hours)


@app.command()
def convert_pecan_street(  # noqa: PLR0913 - a command line has as many options as the format needs
    source: Dataport,
    file: Canonical,
    home: Annotated[int, typer.Option("--home", help="dataid of the home.")],
    weather: Annotated[
        Path, path_option("--weather", "FILE", "CSV file time,outdoor_c, or Dataport's weather table.")
    ],
    prices: Annotated[
        Path | None, path_option("--prices", "FILE", "CSV file time,buy_per_kwh[,sell_per_kwh].")
    ] = None,
    off_peak: Annotated[
        float | None, typer.Option("--off-peak", help="Instead of --prices: price per kWh out of the peak.")
    ] = None,
    peak: Annotated[float | None, typer.Option("--peak", help="Price per kWh in the peak.")] = None,
    peak_hours: Annotated[
        tuple[float, float], typer.Option("--peak-hours", help="Hours from which and until which it lasts.")
    ] = (15.0, 20.0),
    slot_length: Annotated[float, typer.Option("--slot-length", help="Length of a slot in hours.")] = 1.0,
    start: Annotated[str | None, typer.Option("--start", metavar="DATE", help="First day.")] = None,
    stop: Annotated[str | None, typer.Option("--stop", metavar="DATE", help="First day after it.")] = None,
    latitude: Annotated[
        float | None, typer.Option("--latitude", help="Place in a weather table; Austin: 30.292432.")
    ] = None,
    exclude_cars: Annotated[
        bool, typer.Option("--exclude-cars", help="Take the car chargers out of the load.")
    ] = False,
    exclude_battery: Annotated[
        bool, typer.Option("--exclude-battery", help="Take the home's own battery out of the load.")
    ] = False,
    force: Force = False,
) -> None:
    """Write one home of a Pecan Street Dataport file as a canonical trace file; its licence stays with it."""
    from hemma.data import PecanStreetOptions, read_pecan_street, report_quality, write_canonical

    require_new(file, force, ENDINGS)
    options = PecanStreetOptions(
        slot_length=slot_length,
        start=start,
        stop=stop,
        latitude=latitude,
        exclude_cars=exclude_cars,
        exclude_battery=exclude_battery,
    )
    tariff = _prices(prices, off_peak, peak, peak_hours)
    traces = read_pecan_street(source, home, weather=weather, prices=tariff, options=options)
    write_canonical(traces, file)
    for line in report_quality(traces):
        say(line)
