"""What else the learners wrote down: losses, accuracies, learned rewards, policy changes."""

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hemma.report.drawing.canvas import new_figure
from hemma.report.drawing.spread import COST, DEVIATION, SHARE_LABEL, mark_shares, spreads_of
from hemma.report.figures.figure import LEARNING, HomeFigure, Words
from hemma.report.methods import look_of
from hemma.report.subject import Curves

COLUMNS = 3


@dataclass(frozen=True)
class Diagnostic:
    """A column of the learning curves, for people."""

    column: str
    title: str
    unit: str


KNOWN = (
    Diagnostic("discriminator_loss", "Discriminator loss", "nat"),
    Diagnostic("expert_accuracy", "Expert transitions recognised", "fraction"),
    Diagnostic("agent_accuracy", "Agent transitions recognised", "fraction"),
    Diagnostic("learned_reward", "Mean learned reward", "no unit"),
    Diagnostic("reward_gap", "Learned reward, expert − agent", "no unit"),
    Diagnostic("reward", "Hand-written reward", "a slot"),
    Diagnostic("training_loss", "Loss, days learned from", "no unit"),
    Diagnostic("held_out_loss", "Loss, days held out", "no unit"),
    Diagnostic("best_held_out_loss", "Least loss so far, held out", "no unit"),
    Diagnostic("energy_cost", "Energy cost while exploring", "a slot"),
    Diagnostic("temperature_deviation", "Deviation while exploring", "°C"),
    Diagnostic("policy_kl", "Policy change (KL)", "nat"),
    Diagnostic("policy_entropy", "Policy entropy", "nat"),
)


def diagnostics_of(curves: Curves) -> list[Diagnostic]:
    """What the runs hold beside the two curves of every method: known ones first, then as they come."""
    columns = dict.fromkeys(column for runs in curves.values() for run in runs for column in run.quantities)
    known = [diagnostic for diagnostic in KNOWN if diagnostic.column in columns]
    named = {diagnostic.column for diagnostic in known} | {COST, DEVIATION}
    return known + [
        Diagnostic(column, column.replace("_", " ").capitalize(), "")
        for column in columns
        if column not in named
    ]


def diagnostics_figure(curves: Curves) -> Figure:
    """A panel a quantity, a line a method: mean and range over the seeds."""
    diagnostics = diagnostics_of(curves)
    columns = min(COLUMNS, len(diagnostics))
    rows = -(-len(diagnostics) // columns)
    figure = new_figure(9.2, 0.7 + 1.9 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes, diagnostic in zip(panels, diagnostics, strict=False):
        _draw(axes, diagnostic, curves)
    for axes in panels[len(diagnostics) :]:
        axes.set_axis_off()
    for axes in panels[max(0, len(diagnostics) - columns) : len(diagnostics)]:
        axes.set_xlabel(SHARE_LABEL)
    shown = {one.column for one in diagnostics}
    names = [name for name, runs in curves.items() if any(shown & run.quantities.keys() for run in runs)]
    handles = [panels[0].plot([], [], color=look_of(n).colour, linestyle=look_of(n).line)[0] for n in names]
    figure.legend(handles, names, loc="outside upper left", ncols=6)
    return figure


def _draw(axes: Axes, diagnostic: Diagnostic, curves: Curves) -> None:
    axes.set_title(diagnostic.title, fontsize=9.0)
    axes.set_ylabel(diagnostic.unit, fontsize=8.0)
    axes.tick_params(labelsize=7.5)
    mark_shares(axes)
    for name, spread in spreads_of(curves, diagnostic.column).items():
        look = look_of(name)
        axes.fill_between(spread.share, spread.low, spread.high, color=look.colour, alpha=0.18, lw=0)
        axes.plot(spread.share, spread.mean, color=look.colour, linestyle=look.line, lw=1.3)


def _words(curves: Curves) -> Words:
    names = [diagnostic.title.lower() for diagnostic in diagnostics_of(curves)]
    return Words(
        "What else the learners wrote down",
        f"Over the training: {', '.join(names)}.",
        "Line: mean over the seeds; area: their range. Recognised transitions near one half mean that the "
        "discriminator can no longer tell agent from expert.",
    )


TRAINING_DIAGNOSTICS = HomeFigure[Curves](
    name="training-diagnostics",
    section=LEARNING,
    needs=lambda subject: subject.curves if diagnostics_of(subject.curves) else None,
    draw=diagnostics_figure,
    words=_words,
)
