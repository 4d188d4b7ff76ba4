"""Settings that no home has: a unit taken for another, counts without end, files that were damaged."""

import re
from dataclasses import fields, is_dataclass
from random import Random

import pytest

from hemma.errors import HemmaError
from hemma.settings.experiment import Experiment
from hemma.settings.file import read_settings, settings_text
from hemma.settings.keys import key_of
from hemma.settings.plausibility import ANY, limits_of

TEXT = settings_text(Experiment())
LINES = [line for line in TEXT.splitlines() if not line.lstrip().startswith("#")]


def written(tmp_path, text):
    path = tmp_path / "home.yaml"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    ("text", "expected", "looks_like"),
    [
        (
            "comfort: {low_c: 66, high_c: 75}",
            "low_c: expected a temperature in degC from 5 to 35",
            "Fahrenheit",
        ),
        ("comfort: {high_c: 75}", "high_c: expected a temperature in degC from 5 to 35", "Fahrenheit"),
        ("comfort: {low_c: 292, high_c: 297}", "low_c: expected a temperature in degC", "kelvin"),
        ("comfort: {low_c: -300}", "low_c: expected a temperature in degC from 5 to 35, got -300", ""),
        ("initial_indoor_c: 296", "expected a temperature in degC from -20 to 45, got 296", "kelvin"),
        ("initial_indoor_c: 72", "expected a temperature in degC from -20 to 45, got 72", "Fahrenheit"),
        ("hvac: {max_power_kw: 3500}", "hvac.max_power_kw: expected a power in kW from 0 to 200", "W:"),
        ("battery: {max_charging_kw: 5000}", "battery.max_charging_kw: expected a power in kW", "W:"),
        (
            "battery: {max_energy_kwh: 10000}",
            "max_energy_kwh: expected an energy in kWh from 0 to 500",
            "Wh:",
        ),
        ("battery: {max_energy_kwh: 1.0e308}", "max_energy_kwh: expected an energy in kWh", ""),
        ("battery: {max_energy_kwh: 1e400}", "got inf", ""),
        ("battery: {max_energy_kwh: .nan}", "got nan", ""),
        (
            "battery: {max_energy_kwh: -2}",
            "max_energy_kwh: expected an energy in kWh from 0 to 500, got -2",
            "",
        ),
        (
            "battery: {charging_efficiency: 95}",
            "expected an efficiency as a fraction from 0.3 to 1",
            "per cent",
        ),
        ("battery: {ageing_per_kwh: 10}", "ageing_per_kwh: expected a price per kWh from 0 to 3", "cents"),
        ("tariff: {adder_per_kwh: 5}", "adder_per_kwh: expected a price per kWh from 0 to 3", "cents"),
        ("tariff: {selling_ratio: 90}", "selling_ratio: expected a fraction from 0 to 1", "per cent"),
        ("building: {coefficient_of_performance: 250}", "a coefficient of performance from 0.5", "per cent"),
        (
            "building: {coefficient_of_performance: 0}",
            "a coefficient of performance from 0.5 to 10, got 0",
            "",
        ),
        (
            "building: {coefficient_of_performance: 14}",
            "a coefficient of performance from 0.5",
            "an EER or SEER",
        ),
        ("building: {conductance_kw_per_c: 252}", "expected a conductance in kW/degC", "W/degC"),
        ("pv_scale: 1.0e300", "pv_scale: expected a factor from 0 to 50, got 1e+300", ""),
        ("pv_scale: 100", "pv_scale: expected a factor from 0 to 50, got 100", "per cent"),
        ("forecast_horizon_h: 2160", "forecast_horizon_h: expected a time in h from 0.25 to 744", "minutes"),
        ("default: {published_at_h: 1400}", "published_at_h: expected an hour of the day from 0 to 24", ""),
        ("faults: {temperature_noise_c: 300}", "expected a difference in degC from 0 to 10", ""),
        ("faults: {efficiency: 85}", "faults.efficiency: expected an efficiency as a fraction", "per cent"),
        ("seeds: 0", "seeds: expected a number of runs from 1 to 1000, got 0", ""),
        ("seeds: 99999999999999999999", "seeds: expected a number of runs from 1 to 1000, got 9999999", ""),
        ("seeds: 1e20", "seeds: expected a number of runs from 1 to 1000, got 1e+20", ""),
        ("demonstration_days: 10000", "demonstration_days: expected days from 1 to 3660, got 10000", ""),
        ("data_efficiency: {days: [3, 1e9]}", "data_efficiency.days.1: expected days from 1 to 3660", ""),
        ("ppo: {hidden: [64, 100000]}", "ppo.hidden.1: expected units of a layer from 1 to 4096", ""),
        ("ppo: {hidden: [" + "8, " * 200 + "8]}", "ppo.hidden: ", ""),
        ("airl: {iterations: 100000000}", "airl.iterations: expected a number of iterations", ""),
        ("airl: {batch: 100000000}", "airl.batch: expected a number of samples from 1 to 100000", ""),
        ("airl: {members: 10000}", "airl.members: expected a number of agents from 1 to 100", ""),
        ("ppo: {rollouts: 1000000}", "ppo.rollouts: expected a number of rollouts from 1 to 10000", ""),
    ],
)
def test_what_no_home_has_is_refused_with_its_range_and_likely_unit(tmp_path, text, expected, looks_like):
    with pytest.raises(HemmaError, match=r"home\.yaml: line 1: ") as caught:
        read_settings(written(tmp_path, text))
    assert expected in str(caught.value)
    likely = re.search("; this looks like (.*)", str(caught.value))
    assert (likely.group(1) if likely else "").startswith(looks_like)
    assert bool(likely) == bool(looks_like)


@pytest.mark.parametrize(
    "text",
    [
        "battery: {max_energy_kwh: 200, max_charging_kw: 100, max_discharging_kw: 100}",
        "battery: {max_energy_kwh: 0, min_energy_kwh: 0, initial_energy_kwh: 0}",
        "hvac: {max_power_kw: 100, heats: true}\nbuilding: {conductance_kw_per_c: 10}",
        "comfort: {low_c: 5, high_c: 35}\ninitial_indoor_c: -10",
        "comfort: {low_c: 21, high_c: 21}",
        "tariff: {adder_per_kwh: 2.5, selling_ratio: 0}\nbattery: {ageing_per_kwh: 1}\ncurrency: SEK",
        "building: {coefficient_of_performance: 1}",
        "pv_scale: 0",
        "seeds: 1000\ndata_efficiency: {days: []}",
        "pareto: {relaxations_c: [-3, 3]}",
    ],
)
def test_what_homes_have_passes(tmp_path, text):
    read_settings(written(tmp_path, text))


def numbers(value):
    """Class, name and value of every number, and of every list of numbers."""
    for field in fields(value):
        item = getattr(value, field.name)
        if is_dataclass(item):
            yield from numbers(item)
        elif isinstance(item, int | float | tuple) and not isinstance(item, bool):
            yield type(value), field.name, item


def test_every_number_has_limits_of_its_own_and_its_default_lies_inside():
    """One that is added must say what it may be: a line in ``LIMITS`` or ``BY_NAME``."""
    for target, name, value in numbers(Experiment()):
        limits = limits_of(target, name)
        assert limits is not ANY, (target, name)
        for item in value if isinstance(value, tuple) else (value,):
            limits.check(item)


def test_no_default_passes_in_another_unit():
    """In W, Wh, W/degC, ms, minutes, Fahrenheit or kelvin; two defaults are so small that they do."""
    small, tried = ("tolerance_kw", "ageing_per_kwh"), []
    for target, name, value in numbers(Experiment()):
        key = key_of(target, name)
        others = []
        if key.endswith(("_kw", "_kwh", "_kw_per_c", "_s")) and key not in small:
            others = [1000 * value]
        elif key.endswith("_h"):
            others = [60 * value]
        elif key in ("low_c", "high_c", "initial_indoor_c"):
            others = [1.8 * value + 32, value + 273.15]
        for other in others:
            tried.append(key)
            with pytest.raises(ValueError, match=r"^expected .* got "):
                limits_of(target, name).check(other)
    assert len(tried) >= 20


def test_units_stand_in_the_names():
    """A setting whose explanation has a unit of the world has it in its key."""
    ends = {"kWh": "_kwh", "kW": "_kw", "kW electric": "_kw", "degC": "_c", "h": "_h", "s": "_s"}
    explanation, found = "", 0
    for line in TEXT.splitlines()[1:]:
        if line.lstrip().startswith("#"):
            explanation = line
            continue
        unit = re.search(r"\[([^\]]+)\]", explanation)
        if unit is not None and unit.group(1) in ends and not line.endswith(":"):
            found += 1
            assert line.split(":")[0].endswith(ends[unit.group(1)]), line
        explanation = ""
    assert found >= 20
    keys = {line.split(":")[0].strip() for line in LINES}
    assert {"published_at_h", "refitted_days", "held_out_every_days", "adder_per_kwh"} <= keys


SPECIALS = (
    "null",
    "yes",
    "-1",
    "1e308",
    "1e400",
    ".nan",
    "[]",
    "{}",
    "[1, x]",
    "'",
    '"',
    "&a 1",
    "*a",
    "!!int",
)


def changed(line, random):
    """A line with another value, or another number."""
    key, colon, value = line.partition(": ")
    number = re.fullmatch(r"-?[0-9.]+(e-?[0-9]+)?", value)
    if number is None or random.random() < 0.4:
        return f"{key}{colon}{random.choice((*SPECIALS, 'word', '- 1', 'a: b', '%', '<<: 1'))}"
    return f"{key}{colon}{float(value) * random.choice((1000, 0.001, -1, 1e12, 1e-300, 0))!r}"


def mutated(random):
    """The default settings with one to three lines changed, doubled, moved or lost."""
    lines = list(LINES)
    for _ in range(random.randint(1, 3)):
        place = random.randrange(len(lines))
        line, where = lines[place], random.randrange(len(lines[place]) + 1)
        lines[place : place + 1] = random.choice(
            (
                [changed(line, random)],
                [changed(line, random)],
                [line, line],
                [],
                [" " * random.randint(1, 5) + line],
                ["\t" + line.lstrip()],
                [line[:where] + chr(random.randrange(1, 300)) + line[where:]],
                [line[:where]],
                [line.replace(":", "")],
            )
        )
    return "\n".join(lines)


def test_mutated_files_are_read_or_refused_in_one_message(tmp_path):
    random, messages, tries = Random(0), [], 200
    for _ in range(tries):
        path = written(tmp_path, mutated(random))
        try:
            read_settings(path)
        except HemmaError as error:
            messages.append(str(error))
    assert tries / 2 < len(messages) < tries
    for message in messages:
        assert message.startswith(f"{path}: ")
        assert len(message) - len(str(path)) < 600
        assert "\n" not in message
