"""One home under experiment: its traces, cut into training and test, and the home simulated on them."""

from dataclasses import dataclass, replace

from hemma.data import Split, Traces, split
from hemma.errors import HemmaError
from hemma.home import Home
from hemma.results.fingerprint import code, fingerprint
from hemma.results.records import Period
from hemma.results.results import HomeResults
from hemma.settings.experiment import Experiment
from hemma.types import Exogenous

HOURS_OF_A_DAY = 24.0


@dataclass(frozen=True)
class Case:
    """All that the stages need to know about one home."""

    experiment: Experiment
    traces: Traces
    parts: Split
    home: Home
    mark: str
    """Fingerprint of the traces, of where they are cut, and of the home."""

    @property
    def name(self) -> str:
        """The home's name in the results."""
        return self.traces.name

    @property
    def training(self) -> Exogenous:
        """What the training period holds."""
        return self.parts.training.exogenous

    @property
    def test(self) -> Exogenous:
        """What the test period holds."""
        return self.parts.test.exogenous

    @property
    def test_period(self) -> Period:
        """Start and length of the test period, for the records."""
        return _period(self.parts.test)

    @property
    def training_days(self) -> int:
        """Whole days of the training period."""
        return int(self.training.slots * self.traces.slot_length / HOURS_OF_A_DAY + 1e-9)

    def first_days(self, days: int) -> Exogenous:
        """The first ``days`` days of the training period: all that a method with such demonstrations sees."""
        if days > self.training_days:
            raise HemmaError(
                f"{self.name}: expected a training period of at least {days} days for demonstrations of that "
                f"length, got {self.training_days}; set demonstration_days lower or give longer traces"
            )
        return self.training.window(0, round(days * HOURS_OF_A_DAY / self.traces.slot_length))


def make_case(experiment: Experiment, traces: Traces, test_from: str | None = None) -> Case:
    """Cut the traces (by default the last 31 days are the test) and build the home for their slot length."""
    parts = split(traces, test_from)
    home = experiment.home(traces.slot_length)
    mark = fingerprint("case", code("home"), traces.sha256, traces.exogenous, parts.training.slots, home)
    return Case(experiment, traces, parts, home, mark)


def empty_results(case: Case) -> HomeResults:
    """What is known about a home before the first stage."""
    traces, comfort = case.traces, case.home.comfort
    return HomeResults(
        source=traces.source,
        currency=case.experiment.currency,
        notes=traces.notes,
        traces_sha256=traces.sha256,
        slot_length_h=traces.slot_length,
        training=_period(case.parts.training),
        test=case.test_period,
        comfort_c=(float(comfort.low), float(comfort.high)),
    )


def scale_pv(traces: Traces, factor: float) -> Traces:
    """The traces with their PV generation multiplied by ``factor``."""
    exogenous = traces.exogenous
    scaled = Exogenous(
        pv_generation=factor * exogenous.pv_generation,
        load=exogenous.load,
        outdoor_temperature=exogenous.outdoor_temperature,
        buying_price=exogenous.buying_price,
        selling_price=exogenous.selling_price,
        hour_of_day=exogenous.hour_of_day,
    )
    return replace(traces, exogenous=scaled)


def _period(traces: Traces) -> Period:
    return Period(start=traces.time_stamps()[0], slots=traces.slots)
