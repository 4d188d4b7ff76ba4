"""The recommendation in words: what is taken, what it cost, and why not another."""

from hemma.report.page.home import recommendation_section
from hemma.report.tables.recommendation import recommendation_rows, recommendation_sentence
from hemma.results.results import HomeResults

JUDGED = [
    {"method": "Rule", "daily_cost": 2.0, "excess": 1.0, "standard_error": 0.1},
    {"method": "MPC forecast", "daily_cost": 1.01, "excess": 0.01, "standard_error": 0.02},
    {"method": "default", "daily_cost": 1.0, "excess": 0.0, "standard_error": 0.0},
]


def home(recommended, judged=JUDGED):
    entry = {
        "currency": "$",
        "slot_length_h": 1.0,
        "comfort_c": [19.0, 24.0],
        "test": {"start": "2021-08-01T00:00:00-06:00", "slots": 744},
        "methods": {},
    }
    if recommended is not None:
        entry["recommendation"] = {"method": recommended, "days": 30, "judged": judged}
    return HomeResults.model_validate(entry)


def test_the_cheapest_is_named_with_its_cost_and_its_days():
    said = recommendation_sentence("a home", home("default"))
    assert said.startswith(
        "Recommended for a home: default, since it cost $1.000 a day at equal comfort on 30 "
    )
    assert "the least of all" in said


def test_a_simpler_one_is_named_beside_the_cheapest():
    said = recommendation_sentence("a home", home("MPC forecast"))
    assert "MPC forecast, since it cost $1.010" in said
    assert "default cost $1.000, but the difference is within its standard error" in said


def test_the_table_has_a_row_for_each_method_and_no_error_beside_the_least():
    assert recommendation_rows(home("default")) == [
        ("Rule", "$2.000", "$1.000 ± $0.100", "–"),
        ("MPC forecast", "$1.010", "$0.010 ± $0.020", "–"),
        ("default", "$1.000", "$0.000", "–"),
    ]
    assert recommendation_section("a home", home("default")).count("<tr") == 4


def test_where_nothing_was_judged_nothing_is_said():
    assert recommendation_sentence("a home", home(None)) == ""
    assert recommendation_rows(home(None)) == []
    assert recommendation_section("a home", home(None)) == ""


def test_of_the_same_cost_comfort_is_the_reason():
    free = [
        {"method": "Rule", "daily_cost": 0.0, "mean_temperature_deviation": 0.45},
        {"method": "no battery", "daily_cost": 0.0, "mean_temperature_deviation": 0.0},
    ]
    said = recommendation_sentence("a home", home("no battery", free))
    assert "no battery, since it cost $0.000" in said
    assert "of those that cost as little it keeps comfort best" in said
