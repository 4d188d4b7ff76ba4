"""The results of a home in plain words, computed from its numbers."""

from dataclasses import dataclass
from datetime import datetime

from hemma.report.comfort import at_equal_comfort, comfort_warning
from hemma.report.methods import main_method
from hemma.report.numbers import degrees, hundredths, money, percent, plain
from hemma.report.tables.results import is_proven
from hemma.results.records import MethodRuns
from hemma.results.results import HomeResults

DEFAULT = "default"


@dataclass(frozen=True)
class Headline:
    """What a hurried reader takes home."""

    title: str
    text: str


def headline(name: str, home: HomeResults) -> Headline:
    """The main method against Rule and perfect information; what is not there is not spoken of."""
    subject = main_method(home.methods)
    method = home.methods[subject]
    said = (
        _cost_sentence(name, home, subject, method),
        _reference_sentence(home, subject),
        _savings_sentence(home, subject, method),
        _default_sentence(home, subject),
        _comfort_sentence(home, method),
        comfort_warning(home),
    )
    return Headline(title=_title(home, subject, method), text=" ".join(filter(None, said)))


def _cost(home: HomeResults, method: str) -> str:
    """What a method costs; a dash where the home does not have it."""
    return money(home.methods[method].mean.energy_cost if method in home.methods else None, home.currency)


def saved_against_rule(home: HomeResults, method: str) -> float | None:
    """(Rule's cost - the method's cost) / Rule's cost; None without Rule or where Rule earns money."""
    if "Rule" not in home.methods or method == "Rule":
        return None
    rule, cost = home.methods["Rule"].mean.energy_cost, home.methods[method].mean.energy_cost
    return None if rule is None or cost is None or rule <= 0 else (rule - cost) / rule


def _title(home: HomeResults, subject: str, method: MethodRuns) -> str:
    saved, share = saved_against_rule(home, subject), method.mean.share_of_savings
    if saved is None:
        return f"{subject} costs {_cost(home, subject)}"
    against = f"{subject} costs {percent(abs(saved))} {'less' if saved >= 0 else 'more'} than Rule"
    return against if share is None else f"{against} and keeps {percent(share)} of the possible savings"


def _cost_sentence(name: str, home: HomeResults, subject: str, method: MethodRuns) -> str:
    interval = method.interval.energy_cost
    spread = ""
    if interval is not None:
        low, high = (money(bound, home.currency) for bound in interval)
        spread = f" (mean of {len(method.runs)} seeds, 95 % interval {low} to {high})"
    elif method.runs[0].seed is not None:
        spread = " (one seed, so nobody knows its spread)" if len(method.runs) == 1 else ""
    return (
        f"On {name}, over {plain(round(home.test_days, 1))} days from {_date(home.test.start)}, "
        f"{subject} costs {_cost(home, subject)}{spread}."
    )


def _reference_sentence(home: HomeResults, subject: str) -> str:
    parts = []
    if "Rule" in home.methods and subject != "Rule":
        parts.append(f"Rule costs {_cost(home, 'Rule')}")
    if home.optimum is not None and home.optimum.energy_cost is not None:
        unproven = "" if is_proven(home) else " (not proven)"
        best = money(home.optimum.energy_cost, home.currency)
        parts.append(f"perfect information would cost {best}{unproven}")
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}." if text else ""


def _savings_sentence(home: HomeResults, subject: str, method: MethodRuns) -> str:
    share, interval = method.mean.share_of_savings, method.interval.share_of_savings
    if share is None:
        return ""
    spread = "" if interval is None else f" ({hundredths(interval[0])} to {percent(interval[1])})"
    kept = f"{at_equal_comfort(home).capitalize()} {subject} keeps {percent(share)}{spread}"
    return f"{kept} of the savings that a battery makes possible."


def _default_sentence(home: HomeResults, subject: str) -> str:
    """What the controller would do that a home runs, where the report speaks of another."""
    if subject == DEFAULT or DEFAULT not in home.methods:
        return ""
    cost = f"The default controller costs {_cost(home, DEFAULT)}"
    share = home.methods[DEFAULT].mean.share_of_savings
    return f"{cost}." if share is None else f"{cost} and keeps {percent(share)} of them."


def _comfort_sentence(home: HomeResults, method: MethodRuns) -> str:
    low, high = (plain(bound) for bound in home.comfort_c)
    rule = home.methods.get("Rule")
    beside = f" (Rule: {degrees(rule.mean.mean_temperature_deviation)})" if rule and rule != method else ""
    mean = method.mean.mean_temperature_deviation
    if mean is None:
        return ""
    if mean == 0:
        return f"The rooms never leave the comfort band of {low} to {high} °C{beside}."
    return (
        f"The rooms are outside the comfort band of {low} to {high} °C by {degrees(mean)} on average{beside}."
    )


def _date(start: str) -> str:
    try:
        moment = datetime.fromisoformat(start)
    except ValueError:
        return start
    return f"{moment.day} {moment:%B %Y}"


def at_a_glance(home: HomeResults) -> dict[str, str]:
    """The main method beside Rule and perfect information, by heading."""
    subject = main_method(home.methods)
    mean = home.methods[subject].mean
    best = money(home.optimum.energy_cost if home.optimum else None, home.currency)
    return {
        "Method": subject,
        "Energy cost": _cost(home, subject),
        "Rule": _cost(home, "Rule"),
        "Perfect information": best if is_proven(home) else f"{best} (not proven)",
        "Share of savings": percent(mean.share_of_savings),
        "Gap to optimum": percent(mean.gap_to_optimum),
        "Mean deviation": degrees(mean.mean_temperature_deviation),
    }


def range_of_shares(homes: list[HomeResults]) -> str:
    """Range of the main methods' shares of savings over homes, such as ``85.0 to 97.1 %``."""
    shares = [
        share
        for home in homes
        if (share := home.methods[main_method(home.methods)].mean.share_of_savings) is not None
    ]
    if not shares:
        return ""
    low, high = hundredths(min(shares)), percent(max(shares))
    return high if high.startswith(low) else f"{low} to {high}"
