"""Settings files: a round trip keeps everything, and a mistake gives one message with file, key and cure."""

from dataclasses import fields, is_dataclass, replace
from random import Random

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from hemma.errors import HemmaError
from hemma.home import Battery, ComfortBand, Hvac
from hemma.settings.experiment import DataEfficiency, Experiment, quick
from hemma.settings.file import read_settings, settings_text
from hemma.settings.keys import outside


def written(tmp_path, text):
    path = tmp_path / "home.yaml"
    path.write_text(text)
    return path


def test_the_printed_defaults_are_the_defaults(tmp_path):
    assert read_settings(written(tmp_path, settings_text(Experiment()))) == Experiment()
    assert read_settings(written(tmp_path, "")) == Experiment()
    assert read_settings(written(tmp_path, "battery:\n")) == Experiment()


@settings(max_examples=25)
@given(
    max_energy=st.floats(0.7, 100.0),
    low=st.floats(5.0, 20.0),
    seeds=st.integers(1, 50),
    days=st.lists(st.integers(1, 60), unique=True).map(tuple),
    heats=st.booleans(),
    rate=st.floats(1e-7, 1.0),
)
def test_a_round_trip_keeps_every_digit(tmp_path_factory, max_energy, low, seeds, days, heats, rate):
    default = Experiment()
    experiment = replace(
        default,
        battery=Battery(max_energy=max_energy, initial_energy=0.65),
        comfort=ComfortBand(low=low),
        hvac=Hvac(heats=heats),
        seeds=seeds,
        data_efficiency=DataEfficiency(days=days),
        identification=replace(default.identification, learning_rate=rate),
    )
    path = written(tmp_path_factory.mktemp("settings"), settings_text(experiment))
    assert read_settings(path) == experiment


def test_units_stand_in_the_names_and_only_what_is_given_changes(tmp_path):
    text = "battery:\n  max_energy_kwh: 13.5\ncomfort: {high_c: 25}\nppo: {discount: 0.9}\n"
    experiment = read_settings(written(tmp_path, text))
    assert experiment.battery == Battery(max_energy=13.5)
    assert experiment.comfort == ComfortBand(high=25.0)
    assert experiment.ppo.discount == 0.9
    assert experiment.identification == Experiment().identification


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("battery: {max_enrgy_kwh: 5}", r"battery\.max_enrgy_kwh: unknown key; did you mean max_energy_kwh"),
        ("battery: {max_energy: 5}", r"battery\.max_energy: unknown key; did you mean max_energy_kwh"),
        ("xyzzy: blue", r"xyzzy: unknown key; the keys there are battery"),
        ("battery: {max_energy_kwh: -2}", r"battery\.max_energy_kwh: .*greater than or equal to 0, got -2"),
        ("ppo: {learning_rate: -1}", r"ppo\.learning_rate: .*greater than or equal to 0"),
        (
            "battery: {min_energy_kwh: 7}",
            r"battery: expected max_energy_kwh >= min_energy_kwh, got min_energy_kwh 7.0, max_energy_kwh 6.0 "
            r"\(the default\)|battery: expected max_energy_kwh >= min_energy_kwh, got max_energy_kwh 6.0 "
            r"\(the default\), min_energy_kwh 7.0",
        ),
        (
            "battery: {max_energy_kwh: 13.5, min_energy_kwh: 1.35}",
            r"battery: expected min_energy_kwh <= initial_energy_kwh <= max_energy_kwh, got "
            r"max_energy_kwh 13.5, min_energy_kwh 1.35, initial_energy_kwh 1.2 \(the default\)",
        ),
        ("building: {inertia_per_hour: 1}", r"building: expected 0 < inertia_per_hour < 1"),
        ("comfort: {low_c: 66, high_c: 75}", r"comfort\.low_c: .*from 5 to 35.*Fahrenheit.*got 66"),
        ("comfort: {low_c: -300}", r"comfort\.low_c: .*from 5 to 35; got -300"),
        ("comfort: {high_c: 297}", r"comfort\.high_c: .*kelvin.*got 297"),
        ("initial_indoor_c: 296", r"initial_indoor_c: .*kelvin.*got 296"),
        ("initial_indoor_c: 72", r"initial_indoor_c: .*Fahrenheit.*got 72"),
        (
            "hvac: {max_power_kw: 3500}",
            r"hvac\.max_power_kw: .*from 0 to 200; this looks like W, divide",
        ),
        ("battery: {max_energy_kwh: 10000}", r"battery\.max_energy_kwh: .*this looks like Wh"),
        ("battery: {max_energy_kwh: 1.0e308}", r"battery\.max_energy_kwh: .*got 1e\+308"),
        ("battery: {charging_efficiency: 95}", r"battery\.charging_efficiency: .*per cent"),
        ("pv_scale: 1.0e300", r"pv_scale: expected a factor from 0 to 1000; got 1e\+300"),
        ("seeds: 99999999999999999999", r"seeds: expected runs from 1 to 1000; got 9999999999999"),
        ("ppo: {hidden: [64, 100000]}", r"ppo\.hidden: expected units of a layer from 1 to 4096"),
        ("airl: {iterations: 100000000}", r"airl\.iterations: expected a count from 0 to 1e\+06"),
        ("seeds: 2021-13-45", r"seeds: .*integer.*got '2021-13-45'"),
        ("seeds: !!int abc", r"line 1: .*tags such as"),
        ('seeds: !!int ""', r"line 1: .*tags such as"),
        ("seeds: !!python/object:os.system x", r"line 1: .*tags such as"),
        ("battery: &a {}\nhvac: *a", r"line 1: .*anchors and aliases"),
        ("battery: {<<: {max_energy_kwh: 5}}", r"line 1: .*merge keys"),
        ("seeds: " + "[" * 50 + "]" * 50, r"line 1: .*more than 16 levels"),
        ("seeds: " + "[" * 5000, r"line 1: .*more than 16 levels"),
        ("seeds: " + "9" * 5000, r"line 1: .*a number of 5000 characters"),
        ("seeds: 1_0", r"seeds: .*integer.*got '1_0'"),
        ("seeds: 0x10", r"seeds: .*integer.*got '0x10'"),
        ("seeds: 1:30", r"seeds: .*integer.*got '1:30'"),
        ("? [a, b]\n: 1", r"line 1: .*expected a word as key"),
        ("seeds:\t3\n\tx: 1", r"line 1: .*expected YAML"),
        ("learned: " + "x" * 300, r"got '?x{50,58}…"),
        ("time,pv_kw\n2024-01-01T00:00:00Z,1", r"the file: "),
        ("comfort: {high_c: .nan}", r"comfort\.high_c: .*finite"),
        ("comfort: {high_c: warm}", r"comfort\.high_c: .*valid number.*got 'warm'"),
        ("seeds: yes", r"seeds: a number is expected, not yes"),
        (
            "airl: {rollouts: 4}",
            r"airl: expected agent_rollouts of at most rollouts, 4, got rollouts 4, "
            r"agent_rollouts 8 \(the default\)",
        ),
        ("seeds: 0", r"seeds: expected runs from 1 to 1000; got 0"),
        ("seeds: 2.5", r"seeds: .*integer"),
        ("battery: 3", r"battery: .*got 3"),
        ("seeds: 1\nseeds: 2", r"the key seeds stands twice"),
        ("- a list", r"the file: "),
        ("a: [", r"expected YAML"),
    ],
)
def test_a_mistake_is_named_with_file_key_and_value(tmp_path, text, message):
    with pytest.raises(HemmaError, match=r"home\.yaml: (.|\n)*" + message):
        read_settings(written(tmp_path, text))


def test_a_missing_file_and_a_binary_file_are_refused(tmp_path):
    with pytest.raises(HemmaError, match="cannot read it"):
        read_settings(tmp_path / "missing.yaml")
    (tmp_path / "binary.yaml").write_bytes(b"seeds: 1\n\xff\xfe\x00")
    with pytest.raises(HemmaError, match="cannot read it: line 2 is not UTF-8"):
        read_settings(tmp_path / "binary.yaml")
    (tmp_path / "big.yaml").write_bytes(b"#" * 2_000_000)
    with pytest.raises(HemmaError, match="at most 1000000 bytes"):
        read_settings(tmp_path / "big.yaml")


def test_a_decimal_number_is_what_it_looks_like(tmp_path):
    experiment = read_settings(written(tmp_path, "ppo: {learning_rate: 1e-3}\nseeds: 010\npv_scale: +1.5\n"))
    assert (experiment.ppo.learning_rate, experiment.seeds, experiment.pv_scale) == (0.001, 10, 1.5)


LINES = settings_text(Experiment()).splitlines()
VALUES = (
    "null",
    "yes",
    "-1",
    "1e308",
    ".nan",
    "[]",
    "{}",
    "[1, x]",
    "'",
    '"',
    "&a",
    "*a",
    "!!int",
    "1e400",
    "- 1",
)


def mutated(random):
    """The default settings with one to three lines changed, doubled, moved or lost."""
    lines = list(LINES)
    for _ in range(random.randint(1, 3)):
        place = random.randrange(len(lines))
        key, colon, value = lines[place].partition(": ")
        kind = random.randrange(8)
        if kind == 0:
            lines[place] = f"{key}{colon}{random.choice(VALUES)}"
        elif kind == 1 and value.strip().replace(".", "").replace("-", "").isdigit():
            lines[place] = f"{key}{colon}{float(value) * random.choice((1000, 0.001, -1, 1e12))!r}"
        elif kind == 2:
            lines.insert(place, lines[place])
        elif kind == 3:
            del lines[place]
        elif kind == 4:
            lines[place] = " " * random.randint(1, 5) + lines[place]
        elif kind == 5:
            where = random.randrange(len(lines[place]) + 1)
            lines[place] = lines[place][:where] + chr(random.randrange(1, 300)) + lines[place][where:]
        elif kind == 6:
            lines[place] = lines[place][: random.randrange(len(lines[place]) + 1)]
        else:
            lines[place] = lines[place].replace(":", "")
    return "\n".join(lines)


def test_four_hundred_mutated_files_are_read_or_refused_in_one_message(tmp_path):
    random, messages = Random(0), []
    for _ in range(400):
        path = written(tmp_path, mutated(random))
        try:
            read_settings(path)
        except HemmaError as error:
            messages.append(str(error))
    assert 100 < len(messages) < 400
    assert all(message.startswith(f"{path}: ") and len(message) < 1500 for message in messages)


@pytest.mark.parametrize(
    "text",
    [
        f"{section}: {{{key}: {value * factor + shift:g}}}"
        for section, key, value in (
            ("battery", "max_energy_kwh", 6.0),
            ("battery", "max_charging_kw", 3.0),
            ("hvac", "max_power_kw", 2.0),
            ("comfort", "low_c", 19.0),
            ("comfort", "high_c", 24.0),
        )
        for factor, shift in (((9 / 5, 32), (1, 273.15)) if section == "comfort" else ((1000, 0),))
    ],
)
def test_no_temperature_or_power_in_another_unit_passes(tmp_path, text):
    with pytest.raises(HemmaError, match=r"this looks like (Fahrenheit|kelvin|W|Wh),"):
        read_settings(written(tmp_path, text))


def test_every_parameter_is_reachable_from_the_file():
    """Nothing is lost on the way out: as many values in the file as parameters in the tree."""

    def count(value):
        if is_dataclass(value):
            return sum(count(getattr(value, field.name)) for field in fields(value))
        return 1

    def leaves(content):
        return sum(leaves(item) for item in content.values()) if isinstance(content, dict) else 1

    assert leaves(yaml.safe_load(settings_text(Experiment()))) == count(Experiment())
    assert yaml.safe_load(settings_text(Experiment())) == outside(Experiment())


def test_quick_keeps_the_home_and_every_stage():
    experiment = replace(Experiment(), battery=Battery(max_energy=9.0))
    fast = quick(experiment)
    assert fast.battery == experiment.battery
    assert fast.seeds >= 1
    assert fast.data_efficiency.days
    assert fast.airl.iterations < experiment.airl.iterations
