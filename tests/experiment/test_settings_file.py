"""Settings files: a round trip keeps everything, and a mistake gives one message with file, key and cure."""

from dataclasses import fields, is_dataclass, replace

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
    low=st.floats(-20.0, 10.0),
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
        ("battery: {min_energy_kwh: 7}", r"battery: expected max_energy >= min_energy"),
        ("comfort: {high_c: .nan}", r"comfort\.high_c: .*finite"),
        ("comfort: {high_c: warm}", r"comfort\.high_c: .*valid number.*got 'warm'"),
        ("seeds: yes", r"seeds: a number is expected, not yes"),
        ("airl: {rollouts: 4}", r"agent_rollouts of at most rollouts, 4, got 8"),
        ("seeds: 0", r"seeds: expected at least 1, got 0"),
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
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(HemmaError, match="cannot read it"):
        read_settings(tmp_path / "binary.yaml")


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
