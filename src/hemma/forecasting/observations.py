"""What a policy may see besides the paper's state, by name: the last day, published prices, a forecast."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import jax
import numpy as np
from jaxtyping import Float, Int

from hemma.forecasting.outlook import Forecaster, Outlook, yesterday
from hemma.forecasting.published import PublishedPrices
from hemma.rl.policies.scaling import NOTHING, PLAIN, SELLING, Context
from hemma.types import Exogenous, PaperState

QUANTITIES = {
    position.name.lower(): int(position)
    for position in (
        PaperState.PV_GENERATION,
        PaperState.LOAD,
        PaperState.OUTDOOR_TEMPERATURE,
        PaperState.BUYING_PRICE,
    )
}
"""What is seen of other hours, with its position in the paper's state."""
PRICES = ("buying_price", "selling_price")
WINDOWS = (3.0, 6.0, 12.0, 24.0)
"""How far ahead is looked [h], the present slot left out."""
WEEK = 7
BLOCK = 3
"""Days of training that are forecast together, by a forecast fitted to all other training days."""


@dataclass(frozen=True)
class ObservationModel:
    """What a policy sees; all of it is known in the slot, or published.

    ``past``: PV, load, outdoor temperature and price of each of the last 24 hours, and the day of the week.
    ``published``: the coming prices as far as they are published, beyond that those of the day before.
    ``forecast``: a forecast of the coming prices, PV, load and temperatures, and how well it did of late;
    with ``published`` it stands in where nothing is published. Coming prices are seen as the least, greatest
    and mean of the next 3, 6, 12 and 24 hours, other quantities as the mean. Every figure is counted from
    the present value of its quantity.
    """

    name: str
    meaning: str = "the paper's state"
    """What is seen, in plain words."""
    past: bool = False
    published: bool = False
    forecast: bool = False

    @property
    def looks_ahead(self) -> bool:
        """Whether anything is said of the hours to come."""
        return self.published or self.forecast


PAPER = ObservationModel("paper")
_ALL = (
    PAPER,
    ObservationModel("past", "the last 24 hours and the day of the week", past=True),
    ObservationModel(
        "published", "the prices of the coming hours as far as they are published", published=True
    ),
    ObservationModel(
        "forecast", "a forecast of the coming hours, and how well it did of late", forecast=True
    ),
    ObservationModel(
        "past and forecast",
        "the last 24 hours, the day of the week and a forecast of the coming hours",
        past=True,
        forecast=True,
    ),
    ObservationModel(
        "published and forecast",
        "published prices and a forecast of what is not published",
        published=True,
        forecast=True,
    ),
)
MODELS = {model.name: model for model in _ALL}
"""All that there are, by name."""


@dataclass(frozen=True)
class Observer:
    """An observation model at work in one home."""

    model: ObservationModel
    forecaster: Forecaster
    """What is believed of the hours to come where the model has a forecast."""
    published_at: float = 14.0
    """Hour of the day from which tomorrow's prices are known."""
    sells_apart: bool = False
    """Whether the selling price is no line of the buying price: then it is seen as the other one is."""

    @property
    def quantities(self) -> dict[str, int]:
        """What is seen of other hours, with its position among the scaled quantities."""
        return QUANTITIES | ({"selling_price": SELLING} if self.sells_apart else {})

    def context(self, outlook: Outlook, weekdays: Int[np.ndarray, "slots"]) -> Context:
        """What is seen in each slot of the period that ``outlook`` is about, the past being all before it.

        ``weekdays`` are those of the period, Monday 0. A forecast is made from a day earlier on, so that it
        is known how well it did: the past must be a day longer than the forecaster needs.
        """
        outlook, model = replace(outlook, horizon=_horizon(outlook.slot_length)), self.model
        if not model.looks_ahead:
            return self._assembled(outlook, weekdays)
        if not model.forecast:
            return self._assembled(outlook, weekdays, self._published(outlook, yesterday(outlook)))
        earlier = _a_day_earlier(outlook)
        rows = self.forecaster(earlier)
        misses = _misses(earlier, rows, self.quantities)[outlook.day :]
        ahead = jax.tree.map(lambda x: x[outlook.day :], rows)
        return self._assembled(outlook, weekdays, self._published(outlook, ahead), misses)

    def training_context(
        self, training: Exogenous, slots: int, slot_length: float, weekdays: Int[np.ndarray, "slots"]
    ) -> Context:
        """What is seen in the first ``slots`` slots of the ``training`` period, which a learner replays.

        They are whole days in a circle: before the first slot lies the last one. Forecasts of three days are
        fitted to all other days of the training period, so that they err in training as they will later.
        """
        learned = training.window(0, slots)
        circle, misses = Outlook(learned, learned, slot_length, _horizon(slot_length)), None
        if not self.model.looks_ahead:
            return self._assembled(circle, weekdays)
        if self.model.forecast:
            rows = self._crossed(training, circle)
            misses = _misses(circle, rows, self.quantities)
        else:
            rows = _first(yesterday(replace(circle, period=_onwards(circle))), slots)
        return self._assembled(circle, weekdays, self._published_in(circle, rows), misses)

    def training_forecast(
        self, training: Exogenous, slots: int, slot_length: float, horizon: float
    ) -> Exogenous:
        """What is believed in the first ``slots`` slots of the training period of the next ``horizon`` hours.

        Arrays (slots, horizon), as a forecaster gives, with the prices that are published if the model has
        them; made as in ``training_context``, whether the model has a forecast or not.
        """
        learned = training.window(0, slots)
        circle = Outlook(learned, learned, slot_length, horizon)
        return self._published_in(circle, self._crossed(training, circle))

    def _published_in(self, circle: Outlook, rows: Exogenous) -> Exogenous:
        """The rows of a circle with the prices that are published in it."""
        if not self.model.published:
            return rows
        onwards = replace(circle, period=_onwards(circle))
        more = _joined(rows, _first(rows, 2 * circle.day))
        return _first(self._published(onwards, more), circle.period.slots)

    def _published(self, outlook: Outlook, ahead: Exogenous) -> Exogenous:
        if not self.model.published:
            return ahead
        return PublishedPrices(lambda _: ahead, self.published_at)(outlook)

    def _crossed(self, training: Exogenous, circle: Outlook) -> Exogenous:
        """Rows for the slots of ``circle``, each block forecast from the rest of the training period."""
        slots, step = circle.period.slots, BLOCK * circle.day
        parts = []
        for start in range(0, slots, step):
            stop = min(start + step, slots)
            rest = _joined(training.window(stop, training.slots), training.window(0, start))
            parts.append(self.forecaster(replace(circle, past=rest, period=training.window(start, stop))))
        return jax.tree.map(lambda *rows: np.concatenate(rows), *parts)

    def _assembled(
        self,
        outlook: Outlook,
        weekdays: Int[np.ndarray, "slots"],
        ahead: Exogenous | None = None,
        misses: Float[np.ndarray, "slots quantities"] | None = None,
    ) -> Context:
        parts, quantities = [], self.quantities
        if self.model.past:
            parts += [*_last_day(outlook, quantities), _plain(_calendar(weekdays))]
        if ahead is not None:
            range_and_mean = (np.min, np.max, np.mean)
            prices = (one for one in quantities.items() if one[0] in PRICES)
            parts += [_coming(outlook, ahead, price, range_and_mean) for price in prices]
        if self.model.forecast and ahead is not None and misses is not None:
            others = (one for one in quantities.items() if one[0] not in PRICES)
            parts += [_coming(outlook, ahead, other, (np.mean,)) for other in others]
            parts.append(_plain(misses))
        return _beside(parts) if parts else NOTHING


def _horizon(slot_length: float) -> float:
    """How far ahead must be known [h], the present slot included."""
    return WINDOWS[-1] + slot_length


def _last_day(outlook: Outlook, quantities: dict[str, int]) -> list[Context]:
    """Means over each of the last 24 hours, the newest first, from the present value; one a quantity."""
    joined, first = outlook.joined(), outlook.past.slots
    hour = outlook.hour
    hours = max(outlook.day // hour, 1)
    ends = np.arange(first, first + outlook.period.slots)[:, None] - hour * np.arange(hours)
    parts = []
    for name, position in quantities.items():
        values = getattr(joined, name)
        total = np.concatenate([[0.0], np.cumsum(values)])
        starts = np.maximum(ends - hour, 0)
        means = (total[ends] - total[starts]) / np.maximum(ends - starts, 1)
        parts.append(_counted(means, values[first:], position))
    return parts


def _coming(outlook: Outlook, ahead: Exogenous, quantity: tuple[str, int], statistics: tuple) -> Context:
    """Statistics of the next hours, from the present value."""
    name, position = quantity
    rows = np.asarray(getattr(ahead, name), float)
    columns = []
    for window in WINDOWS:
        stop = 1 + max(round(window / outlook.slot_length), 1)
        columns += [statistic(rows[:, 1:stop], axis=1) for statistic in statistics]
    return _counted(np.stack(columns, axis=1), np.asarray(getattr(outlook.period, name), float), position)


def _misses(outlook: Outlook, rows: Exogenous, names: Iterable[str]) -> Float[np.ndarray, "slots quantities"]:
    """Of each quantity, how far the forecast of a day ago missed the day since, as a share of its spread.

    Root mean square of what row t - 24 h said of the slots since, over the standard deviation of the quantity
    in the past; the first day, of which nothing was forecast, has that of the slot after it.
    """
    day, slots = outlook.day, outlook.period.slots
    made = np.arange(max(slots - day, 0))[:, None] + np.arange(1, day + 1)
    columns = []
    for name in names:
        truth, said = np.asarray(getattr(outlook.period, name), float), np.asarray(getattr(rows, name), float)
        deviation = float(np.std(np.asarray(getattr(outlook.past, name), float))) or 1.0
        missed = np.full(slots, np.nan)
        missed[day:] = np.sqrt(np.mean((said[: len(made), 1 : day + 1] - truth[made]) ** 2, axis=1))
        known = missed[day] if slots > day else 0.0
        columns.append(np.where(np.isnan(missed), known, missed) / deviation)
    return np.stack(columns, axis=1)


def _calendar(weekdays: Int[np.ndarray, "slots"]) -> Float[np.ndarray, "slots 2"]:
    """Sine and cosine of the day of the week."""
    angle = 2 * np.pi * np.asarray(weekdays) / WEEK
    return np.stack([np.sin(angle), np.cos(angle)], axis=1)


def _counted(
    figures: Float[np.ndarray, "slots figures"], present: Float[np.ndarray, "slots"], position: int
) -> Context:
    origins = np.broadcast_to(present[:, None], figures.shape)
    return Context(figures, origins, np.full(figures.shape[1], position))


def _plain(figures: Float[np.ndarray, "slots figures"]) -> Context:
    return Context(figures, np.zeros_like(figures), np.full(figures.shape[1], PLAIN))


def _beside(parts: list[Context]) -> Context:
    figures = np.concatenate([part.figures for part in parts], axis=1)
    origins = np.concatenate([part.origins for part in parts], axis=1)
    return Context(figures, origins, np.concatenate([part.kinds for part in parts]))


def _a_day_earlier(outlook: Outlook) -> Outlook:
    """The same outlook with the last day of the past as the first of the period."""
    cut = outlook.past.slots - outlook.day
    joined = outlook.joined()
    return replace(outlook, past=joined.window(0, cut), period=joined.window(cut, joined.slots))


def _joined(first: Exogenous, second: Exogenous) -> Exogenous:
    return jax.tree.map(lambda a, b: np.concatenate([np.asarray(a), np.asarray(b)]), first, second)


def _onwards(circle: Outlook) -> Exogenous:
    """A circle's slots, and two more days of them."""
    return _joined(circle.period, circle.period.window(0, 2 * circle.day))


def _first(rows: Exogenous, slots: int) -> Exogenous:
    return jax.tree.map(lambda x: x[:slots], rows)
