"""``hemma data``: look at traces, and bring them into the canonical form."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hemma.cli.console import say
from hemma.cli.files import Force, named, require_new

if TYPE_CHECKING:
    from hemma.data import TimeOfUse

app = typer.Typer(help="Look at traces and bring them into the canonical form.", no_args_is_help=True)

ENDINGS = (".csv", ".csv.gz")
Canonical = Annotated[
    Path,
    typer.Argument(
        parser=named, metavar="FILE", help="Canonical trace file, .csv or .csv.gz.", show_default=False
    ),
]
Dataport = Annotated[
    Path,
    typer.Argument(
        parser=named, metavar="SOURCE", help="Pecan Street Dataport file, .csv, .csv.gz or .tar.gz."
    ),
]


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
    metadata: Annotated[
        Path | None, typer.Option("--metadata", parser=named, metavar="FILE", help="Dataport's metadata.csv.")
    ] = None,
) -> None:
    """Say which homes a Pecan Street Dataport file holds and what is instrumented in them."""
    from hemma.data import list_pecan_street_homes

    for home in list_pecan_street_homes(source, metadata):
        place = f", {home.city}" if home.city else ""
        say(f"{home.home}: {home.first} to {home.last}, {', '.join(home.circuits)}{place}")


@dataclass(frozen=True)
class _Prices:
    """Where the prices of a Pecan Street home come from: a file, or a time-of-use tariff."""

    file: Path | None
    off_peak: float | None
    peak: float | None
    hours: tuple[float, float]

    @property
    def source(self) -> "Path | TimeOfUse":
        from hemma.data import TimeOfUse
        from hemma.errors import HemmaError

        tariff = (self.off_peak, self.peak)
        if self.file is not None and tariff == (None, None):
            return self.file
        if self.file is not None or self.off_peak is None or self.peak is None:
            raise HemmaError("expected prices: either --prices FILE, or both --off-peak and --peak")
        return TimeOfUse(self.off_peak, self.peak, *self.hours)


@app.command()
def convert_pecan_street(  # noqa: PLR0913 - a command line has as many options as the format needs
    source: Dataport,
    file: Canonical,
    home: Annotated[int, typer.Option("--home", help="dataid of the home.")],
    weather: Annotated[
        Path,
        typer.Option(
            "--weather",
            parser=named,
            metavar="FILE",
            help="CSV file time,outdoor_c, or Dataport's weather table.",
        ),
    ],
    prices: Annotated[
        Path | None,
        typer.Option(
            "--prices", parser=named, metavar="FILE", help="CSV file time,buy_per_kwh[,sell_per_kwh]."
        ),
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
    tariff = _Prices(prices, off_peak, peak, peak_hours).source
    traces = read_pecan_street(source, home, weather=weather, prices=tariff, options=options)
    write_canonical(traces, file)
    for line in report_quality(traces):
        say(line)
