"""The sections of the report that compare the methods of one home."""

from hemma.evaluation import RegretSplit
from hemma.report.methods import grouped, main_method
from hemma.report.numbers import money
from hemma.report.page.markup import body, cell, figure_or, heading, row, table
from hemma.report.pictures import HomePictures
from hemma.results.results import HomeResults

REGRET_HEADINGS = ("Method", "Regret", "Not knowing the future", "Identified thermal model", "Policy")


def comparisons_section(home: HomeResults, pictures: HomePictures) -> str:
    """Cost against comfort, where regret comes from, and how sure the differences are."""
    return (
        heading(3, "Cost against comfort")
        + figure_or(pictures.pareto, "No sweep of cost against comfort in this folder.")
        + heading(3, "Where the regret comes from")
        + figure_or(pictures.regret, "The regret is not split in this folder.")
        + (_regret_table(home) if home.regret else "")
        + heading(3, "How sure the differences are")
        + figure_or(
            pictures.improvement, "No learned method is compared with another run by run in this folder."
        )
    )


def _regret_table(home: HomeResults) -> str:
    main = main_method(home.methods)
    bodies = [
        body(
            [_regret_row(name, home.regret[name], home.currency, name == main) for name in names],
            title,
            len(REGRET_HEADINGS),
        )
        for title, names in grouped(home.regret).items()
    ]
    return table("Regret and its parts, means over the seeds", REGRET_HEADINGS, bodies)


def _regret_row(name: str, split: RegretSplit, currency: str, is_main: bool) -> str:
    amounts = (split.total, split.future, split.thermal_model, split.policy)
    return row(name, [cell(money(amount, currency)) for amount in amounts], "main" if is_main else "")
