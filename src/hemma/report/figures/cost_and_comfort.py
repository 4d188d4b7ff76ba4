"""Cost against comfort: the proven frontier, what sweeps reach, and where every method stands."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from hemma.report.drawing.canvas import FAINT, INK, LINEAR_BELOW, label_deviation, literal, new_figure
from hemma.report.drawing.labels import Label, place_labels
from hemma.report.figures.figure import HomeFigure, ReportSection, Words
from hemma.report.methods import in_order, look_of
from hemma.report.numbers import degrees, money, rough
from hemma.results.findings import ParetoPoint
from hemma.results.results import HomeResults

FRONTIER = "optimum"
_ENLARGED = 0.7
"""The dearer methods get a panel of their own if the rest needs less than this part of the axis."""
_MARGIN = 0.08


@dataclass(frozen=True)
class SweptSeries:
    """The points of one series, by the value of what was swept."""

    name: str
    points: tuple[ParetoPoint, ...]

    @property
    def track(self) -> np.ndarray:
        """Mean deviation [degC] and energy cost [currency], shape (points, 2)."""
        return np.array([(p.mean_temperature_deviation, p.energy_cost) for p in self.points], float)

    @property
    def legend(self) -> str:
        """What it is in words."""
        if self.name == FRONTIER:
            return "proven least cost for each comfort"
        swept, values = parameter_name(self.points[0]), [p.value for p in self.points if p.value is not None]
        span = f" from {rough(values[0])} to {rough(values[-1])}" if len(values) > 1 else ""
        return f"{literal(self.name)}, {swept}{span}" if swept else literal(self.name)


@dataclass(frozen=True)
class Standing:
    """A method at its mean deviation and cost."""

    name: str
    deviation: float
    cost: float


def parameter_name(point: ParetoPoint) -> str:
    """What was swept, as a figure writes it: formulas between dollar signs."""
    return literal(point.parameter).replace("beta_T", r"$\beta_T$")


def sweeps_of(home: HomeResults) -> list[SweptSeries]:
    """The series that have points, the frontier first; each in the order of what was swept."""
    known = [p for p in home.pareto if None not in (p.energy_cost, p.mean_temperature_deviation)]
    names = sorted(dict.fromkeys(p.series for p in known), key=lambda name: name != FRONTIER)
    known.sort(key=lambda p: (p.mean_temperature_deviation if p.series == FRONTIER else p.value) or 0.0)
    return [SweptSeries(name, tuple(p for p in known if p.series == name)) for name in names]


def standings(home: HomeResults) -> list[Standing]:
    """All methods that have both numbers, in their order."""
    means = {name: home.methods[name].mean for name in in_order(home.methods)}
    return [
        Standing(name, mean.mean_temperature_deviation, mean.energy_cost)
        for name, mean in means.items()
        if mean.mean_temperature_deviation is not None and mean.energy_cost is not None
    ]


def pareto_figure(home: HomeResults) -> Figure:
    """Energy cost over mean deviation; if some methods are much dearer, beside it the others enlarged."""
    sweeps, methods = sweeps_of(home), standings(home)
    costs = [*(m.cost for m in methods), *(y for sweep in sweeps for y in sweep.track[:, 1])]
    low, high, cut = min(costs), max(costs), _cut(methods, sweeps)
    is_split = cut - low < _ENLARGED * (high - low)
    figure = new_figure(9.2, 5.6)
    ratios = (1.0, 1.7) if is_split else (1.0,)
    whole, *enlarged = figure.subplots(1, len(ratios), squeeze=False, width_ratios=ratios).ravel()
    _draw(whole, sweeps, methods, (low, high))
    whole.set_ylabel(f"Energy cost of the test period ({home.currency})")
    legend = figure.legend(*whole.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    for text in legend.get_texts():
        text.set_parse_math(True)
    if not is_split:
        _name(whole, methods, sweeps, (low, high))
        return figure
    [part] = enlarged
    _draw(part, sweeps, methods, (low, cut))
    whole.set_title("All methods")
    part.set_title("The frame, enlarged")
    (left, right), (bottom, top) = part.get_xlim(), part.get_ylim()
    frame = Rectangle((left, bottom), right - left, top - bottom, fill=False, color=FAINT, lw=0.8, ls=":")
    whole.add_patch(frame)
    _name(whole, [m for m in methods if m.cost > cut], sweeps, (cut, high))
    _name(part, [m for m in methods if m.cost <= cut], sweeps, (low, cut))
    return figure


def _cut(methods: Sequence[Standing], sweeps: Sequence[SweptSeries]) -> float:
    """The cost below which three quarters of the methods stand, and the whole frontier."""
    frontier = [float(np.max(sweep.track[:, 1])) for sweep in sweeps if sweep.name == FRONTIER]
    costs = sorted(m.cost for m in methods)
    return max([costs[(3 * len(costs)) // 4] if len(costs) > 3 else costs[-1], *frontier])


def _draw(
    axes: Axes, sweeps: Sequence[SweptSeries], methods: Sequence[Standing], costs: tuple[float, float]
) -> None:
    """All sweeps and the methods up to the higher of the costs, on axes from the lower to the higher."""
    low, high = costs
    axes.set_xscale("symlog", linthresh=LINEAR_BELOW, linscale=0.5)
    for sweep in sweeps:
        look, (x, y) = look_of(sweep.name), sweep.track.T
        # Between two points of a sweep there is nothing: a line would seem to cross the proven one.
        style, size = (".-", 4) if sweep.name == FRONTIER else (look.marker, 3.5)
        axes.plot(x, y, style, color=look.colour, ms=size, lw=1.3, label=sweep.legend, alpha=0.8)
    edge = {"mec": "white", "mew": 0.7}
    for method in methods:
        if method.cost <= high:
            x, y, look = method.deviation, method.cost, look_of(method.name)
            axes.plot(x, y, look.marker, color=look.colour, ms=6.5, zorder=4, clip_on=False, **edge)
    margin = _MARGIN * (high - low) or 1.0
    axes.set_ylim(low - margin, high + margin)
    seen = [*(m.deviation for m in methods), *(x for sweep in sweeps for x in sweep.track[:, 0])]
    axes.set_xlim(-LINEAR_BELOW / 4, 3.0 * max(LINEAR_BELOW, *seen))
    label_deviation(axes)


def _name(
    axes: Axes, methods: Sequence[Standing], sweeps: Sequence[SweptSeries], costs: tuple[float, float]
) -> None:
    """The names of the methods, and of each sweep the value at either end if it is among the costs."""
    ends = [
        Label(
            f"{parameter_name(point)} {rough(point.value)}",
            point.mean_temperature_deviation or 0.0,
            point.energy_cost or 0.0,
            look_of(sweep.name).colour,
            size=6.8,
        )
        for sweep in sweeps
        if sweep.name != FRONTIER and len(sweep.points) > 1
        for point in (sweep.points[0], sweep.points[-1])
        if point.value is not None and costs[0] <= (point.energy_cost or 0.0) <= costs[1]
    ]
    names = [Label(literal(m.name), m.deviation, m.cost, INK) for m in methods]
    place_labels(axes, [*names, *ends], [sweep.track for sweep in sweeps])


def _words(home: HomeResults) -> Words:
    methods = "; ".join(
        f"{m.name} {money(m.cost, home.currency)} at {degrees(m.deviation)}" for m in standings(home)
    )
    sweeps = sweeps_of(home)
    swept = "; ".join(
        f"{sweep.name}, {point.parameter.replace('beta_T', 'weight of comfort')} {rough(point.value)}: "
        f"{money(point.energy_cost, home.currency)} at {degrees(point.mean_temperature_deviation)}"
        for sweep in sweeps
        for point in sweep.points
        if point.value is not None
    )
    has_frontier = any(sweep.name == FRONTIER for sweep in sweeps)
    proven = "No controller can stand below the black line: it is proven for each deviation. "
    return Words(
        "Cost against comfort",
        f"Energy cost at mean deviation. Methods: {methods}. Sweeps: {swept or 'none'}.",
        f"{proven if has_frontier else ''}Down is cheaper, left is more comfortable. The small marks show "
        "what one method reaches when the weight of comfort, or the band that it is given, is changed.",
    )


COST_AND_COMFORT = HomeFigure[HomeResults](
    name="cost-and-comfort",
    section=ReportSection("Cost against comfort"),
    needs=lambda subject: subject.home if sweeps_of(subject.home) and standings(subject.home) else None,
    draw=pareto_figure,
    words=_words,
    missing="No sweep of cost against comfort in this folder.",
)
