"""How well the physically consistent network predicts a month that it never saw, and what fitting costs.

    python benchmarks/identification.py simulated     homes of known equations, excited in June and July
    python benchmarks/identification.py logged        what the thermostats of the embedded homes logged
    python benchmarks/identification.py trials        other settings, on the days before August alone

The numbers stand in docs/identification.md. Errors [degC] are on August except in the trials; "physical"
is the start, f = 0.
"""

import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import jax
import jax.numpy as jnp
import numpy as np

from hemma.data import AUSTIN2021_HOMES, load_austin2021
from hemma.home import (
    AbstractThermalModel,
    ExplicitThermalModel,
    Home,
    Hvac,
    ThermalDrivers,
    ThermalState,
    benchmark_home,
)
from hemma.identification import (
    Excitation,
    Fit,
    FreeRunErrors,
    IdentificationSettings,
    PhysicallyConsistentNetwork,
    ThermalRecord,
    ThermalResponse,
    excite,
    fit,
    free_run_errors,
    logged_record,
)
from hemma.types import Exogenous

AUGUST = 61 * 24
"""First hour of August; the data begin on 1 June."""
FAR_START = ThermalResponse(heating=1.0, cooling=1.0, loss=0.1)
"""A third of the true response of the benchmark home."""


class SunlitModel(AbstractThermalModel):
    """The explicit model with gains: 0.4 degC/h per kW of PV, and people, up to 0.6 degC/h at 19 h."""

    envelope: ExplicitThermalModel
    slot_length: float

    def __call__(self, state: ThermalState, drivers: ThermalDrivers) -> ThermalState:
        """State at the end of the slot."""
        people = 0.3 * (1 + jnp.cos(2 * jnp.pi * (drivers.hour_of_day - 19) / 24))
        gains = self.slot_length * (0.4 * drivers.pv_generation + people)
        T = self.envelope(state, drivers).indoor_temperature + gains
        return ThermalState(indoor_temperature=T, memory=T)


@dataclass(frozen=True)
class Case:
    """A home, its weather, and where training starts."""

    name: str
    home: Home
    exogenous: Exogenous
    start: ThermalResponse | None = None


def cases(exogenous: Exogenous) -> Iterator[Case]:
    """Summer and winter, hours and quarters, still and disturbed, without and with gains."""
    summer = benchmark_home()
    winter = replace(summer, hvac=Hvac(max_power=3.0, heats=True), initial_temperature=20.0)
    cold = replace(exogenous, outdoor_temperature=exogenous.outdoor_temperature - 26)
    quarters = benchmark_home(0.25)
    fine = in_quarters(exogenous)
    yield Case("summer", summer, exogenous)
    yield Case("summer, far start", summer, exogenous, FAR_START)
    yield Case("summer, disturbed", disturbed(summer), exogenous)
    yield Case("summer, gains", sunlit(summer), exogenous)
    yield Case("summer, gains, disturbed", disturbed(sunlit(summer)), exogenous)
    yield Case("winter", winter, cold)
    yield Case("winter, gains", sunlit(winter), cold)
    yield Case("quarter hours", quarters, fine)
    yield Case("quarter hours, disturbed", disturbed(quarters), fine)
    yield Case("quarter hours, gains", sunlit(quarters), fine)


def disturbed(home: Home) -> Home:
    """The home with a disturbance of 0.1 degC a slot."""
    return replace(home, disturbance_deviation=0.1)


def sunlit(home: Home) -> Home:
    """The home with gains."""
    assert isinstance(home.thermal_model, ExplicitThermalModel)
    return replace(home, thermal_model=SunlitModel(home.thermal_model, float(home.slot_length)))


def in_quarters(exogenous: Exogenous) -> Exogenous:
    """Hourly traces at quarter hours: PV and outdoor temperature interpolated, the rest held."""
    hours = np.arange(exogenous.slots)
    quarters = np.arange(4 * exogenous.slots) / 4
    return replace(
        jax.tree.map(lambda x: np.repeat(x, 4), exogenous),
        pv_generation=np.interp(quarters, hours, exogenous.pv_generation),
        outdoor_temperature=np.interp(quarters, hours, exogenous.outdoor_temperature),
        hour_of_day=(exogenous.hour_of_day[0] + quarters) % 24,
    )


def show(
    name: str, days: int, record: ThermalRecord, test: ThermalRecord, start: ThermalResponse | None
) -> None:
    """Fit on ``record``, measure on ``test``, print a row."""
    begun = time.perf_counter()
    fitted = fit(record, IdentificationSettings(), jax.random.key(0), start)
    seconds = time.perf_counter() - begun
    physical, network = (
        free_run_errors(physical_only(fitted.model), test),
        free_run_errors(fitted.model, test),
    )
    print(
        f"{name:34s} {days:3d} {seconds:5.1f} {row(physical)}   {row(network)} {response(fitted)}", flush=True
    )


def physical_only(model: PhysicallyConsistentNetwork) -> PhysicallyConsistentNetwork:
    """The model as it was before training."""
    return replace(model, weights=jax.tree.map(jnp.zeros_like, model.weights))


def row(errors: FreeRunErrors) -> str:
    """The four errors."""
    return " ".join(f"{e:6.3f}" for e in (errors.one_hour, errors.six_hours, errors.day, errors.month))


def response(fitted: Fit) -> str:
    """What was identified."""
    model = fitted.model
    return f"  b {model.loss_share:.4f}  d {model.cooling_response:.3f}  update {fitted.best_update}"


def simulated() -> None:
    """Every case on home 1, the first on every home; June and July or the last 15 days of July."""
    for number in AUSTIN2021_HOMES:
        exogenous = load_austin2021(number).exogenous
        for case in cases(exogenous):
            if number > 1 and case.name not in ("summer", "summer, disturbed"):
                continue
            hour = round(1 / float(case.home.slot_length))
            parts = case.exogenous.window(0, AUGUST * hour), case.exogenous.window(AUGUST * hour, 2208 * hour)
            still = replace(case.home, disturbance_deviation=0.0)
            test = excite(still, parts[1], Excitation(), jax.random.key(number))
            for days in (61, 15):
                training = parts[0].window((AUGUST - 24 * days) * hour, AUGUST * hour)
                record = excite(case.home, training, Excitation(), jax.random.key(100 + number))
                show(f"home {number}, {case.name}", days, record, test, case.start)


def logged() -> None:
    """The embedded homes as their own thermostats ran them."""
    for number in AUSTIN2021_HOMES:
        record = log_of(number)
        test = record.window(AUGUST, record.slots)
        for days in (61, 15):
            show(f"home {number}, logged", days, record.window(AUGUST - 24 * days, AUGUST), test, None)


def log_of(number: int) -> ThermalRecord:
    """The logged temperatures and powers of an embedded home."""
    traces = load_austin2021(number)
    assert traces.indoor_temperature is not None
    assert traces.hvac_power is not None
    return logged_record(benchmark_home(), traces.exogenous, traces.indoor_temperature, traces.hvac_power)


TRIALS = {
    "default": IdentificationSettings(),
    "gain_penalty 0": IdentificationSettings(gain_penalty=0.0),
    "gain_penalty 0.1": IdentificationSettings(gain_penalty=0.1),
    "gain_penalty 1": IdentificationSettings(gain_penalty=1.0),
    "window 24 h": IdentificationSettings(window=24.0),
    "window 72 h": IdentificationSettings(window=72.0),
    "learning_rate 5e-4 (the paper's)": IdentificationSettings(learning_rate=5e-4),
    "learning_rate 3e-3": IdentificationSettings(learning_rate=3e-3),
    "depth 2": IdentificationSettings(depth=2),
    "width 64": IdentificationSettings(width=64),
    "least_improvement 0": IdentificationSettings(least_improvement=0.0),
}


def trials() -> None:
    """Each setting on 15 days to mid July (simulated) or 45 (logged), tested on 16 to 31 July."""
    middle = AUGUST - 16 * 24
    exogenous = load_austin2021(1).exogenous
    chosen = [case for case in cases(exogenous) if case.name.startswith("summer,")]
    logs = []
    for number in AUSTIN2021_HOMES:
        log = log_of(number)
        logs.append((log.window(0, middle), log.window(middle, AUGUST)))
    print(f"{'trial':34s} {' '.join(f'{case.name[8:]:>16s}' for case in chosen)}  logged: 24 h, 16 days")
    for name, settings in TRIALS.items():
        print(f"{name:34s}", end="", flush=True)
        for case in chosen:
            record = excite(
                case.home, exogenous.window(middle - 360, middle), Excitation(), jax.random.key(1)
            )
            still = replace(case.home, disturbance_deviation=0.0)
            test = excite(still, exogenous.window(middle, AUGUST), Excitation(), jax.random.key(2))
            model = fit(record, settings, jax.random.key(0), case.start).model
            print(f" {free_run_errors(model, test).month:16.4f}", end="", flush=True)
        errors = [free_run_errors(fit(a, settings, jax.random.key(0)).model, b) for a, b in logs]
        print(
            f"  {np.mean([e.day for e in errors]):12.3f} {np.mean([e.month for e in errors]):8.3f}",
            flush=True,
        )


if __name__ == "__main__":
    columns = "   1 h    6 h   24 h  month"
    if sys.argv[1] != "trials":
        print(f"{'':34s}            {'physical':27s}   network")
        print(f"{'case':33s} days     s {columns}   {columns}")
    {"simulated": simulated, "logged": logged, "trials": trials}[sys.argv[1]]()
