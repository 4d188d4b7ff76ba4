"""Observation models: figures by hand, nothing from the future, and training days as later days will be."""

from dataclasses import replace

import jax
import numpy as np
import pytest

from hemma.forecasting.observations import MODELS, QUANTITIES, Observer
from hemma.forecasting.outlook import Outlook, hourly_means, yesterday
from hemma.forecasting.published import PublishedPrices
from hemma.rl.policies.scaling import SELLING
from small_worlds import changed_after, cut, hourly_export, noisy, periodic

SEEING = tuple(model for model in MODELS.values() if model.name != "paper")
SIZES = {
    "past": 4 * 24 + 2,
    "published": 12,
    "forecast": 12 + 3 * 4 + 4,
    "past and forecast": 4 * 24 + 2 + 28,
    "published and forecast": 28,
}


def weekdays(slots, slot_length=1.0):
    return np.floor(np.arange(slots) * slot_length / 24).astype(int) % 7


def outlook(exogenous, past_days=4, slot_length=1.0):
    past, period = cut(exogenous, round(past_days * 24 / slot_length))
    return Outlook(past, period, slot_length, 36.0)


def seen(model, world, slot_length=1.0):
    return Observer(model, hourly_means).context(world, weekdays(world.period.slots, slot_length))


@pytest.mark.parametrize("model", SEEING, ids=lambda model: model.name)
@pytest.mark.parametrize("slot_length", [1.0, 0.25])
def test_there_is_a_finite_row_for_every_slot_and_as_many_figures_for_any_slot_length(model, slot_length):
    world = outlook(noisy(6, 0, slot_length), 4, slot_length)
    context = seen(model, world, slot_length)
    assert context.figures.shape == context.origins.shape == (world.period.slots, SIZES[model.name])
    assert context.kinds.shape == (SIZES[model.name],)
    assert np.all(np.isfinite(context.figures - context.origins))


def test_the_papers_state_has_no_more_to_see():
    assert seen(MODELS["paper"], outlook(noisy(6, 0))).figures.shape[1] == 0


def test_the_last_day_by_hand():
    world = outlook(noisy(6, 1))
    context, joined = seen(MODELS["past"], world), world.joined()
    slot, lag = 5, 3
    for number, (name, position) in enumerate(QUANTITIES.items()):
        column = 24 * number + lag - 1
        values = getattr(joined, name)
        np.testing.assert_allclose(context.figures[slot, column], values[96 + slot - lag])
        np.testing.assert_allclose(context.origins[slot, column], values[96 + slot])
        assert context.kinds[column] == position
    angle = 2 * np.pi * weekdays(48)[slot] / 7
    np.testing.assert_allclose(context.figures[slot, -2:], [np.sin(angle), np.cos(angle)])


@pytest.mark.parametrize("model", SEEING, ids=lambda model: model.name)
def test_a_selling_price_of_its_own_is_seen_as_the_buying_price_is(model):
    """Behind the figures of the other quantities, and those stay as they are."""
    exogenous, world = hourly_export(8), outlook(hourly_export(8))
    plain = seen(model, world)
    context = Observer(model, hourly_means, sells_apart=True).context(world, weekdays(world.period.slots))
    own, n = np.flatnonzero(context.kinds == SELLING), world.period.slots
    assert len(own) == 24 * model.past + 12 * model.looks_ahead
    others = [place for place in range(len(context.kinds)) if place not in own]
    others = others[:-1] if model.forecast else others  # the last figure says how it was missed
    np.testing.assert_array_equal(context.figures[:, others], plain.figures)
    np.testing.assert_array_equal(
        context.origins[:, own], np.broadcast_to(exogenous.selling_price[96:, None], (n, len(own)))
    )
    if model.looks_ahead:
        tomorrow = exogenous.selling_price[96 + 11 : 96 + 10 + 25]
        expected = [f(tomorrow[:w]) for w in (3, 6, 12, 24) for f in (np.min, np.max, np.mean)]
        np.testing.assert_allclose(context.figures[10, own[-12:]], expected)


def test_hours_gone_by_are_means_where_slots_are_short():
    world = outlook(noisy(6, 1, 0.25), 4, 0.25)
    context, price = seen(MODELS["past"], world, 0.25), world.joined().buying_price
    now = 4 * 96 + 7
    np.testing.assert_allclose(context.figures[7, 72], np.mean(price[now - 4 : now]))
    np.testing.assert_allclose(context.figures[7, 73], np.mean(price[now - 8 : now - 4]))


def test_published_prices_by_hand():
    """At 10:00 today's prices are known, and yesterday's stand for tomorrow's; at 14:00 those, too."""
    world = outlook(noisy(8, 2), 4)
    context, price = seen(MODELS["published"], world), world.joined().buying_price
    for hour, known in ((10, 24), (14, 48)):
        now = 96 + hour
        ahead = np.concatenate([price[now : 96 + known], price[72 + known :]])[1:]
        if known == 24:  # what is not published is taken from the day before at that time
            ahead = np.concatenate([price[now : 96 + 24], price[96 : 96 + hour + 1], price[72 + hour + 1 :]])[
                1:
            ]
        expected = [f(ahead[:w]) for w in (3, 6, 12) for f in (np.min, np.max, np.mean)]
        np.testing.assert_allclose(context.figures[hour, :9], expected)
        np.testing.assert_allclose(context.origins[hour, :9], price[now])


def test_a_forecast_by_hand():
    world = outlook(noisy(8, 3), 4)
    context = seen(MODELS["forecast"], world)
    earlier = Outlook(world.joined().window(0, 72), world.joined().window(72, 192), 1.0, 25.0)
    rows, slot = hourly_means(earlier), 9
    price, load = np.asarray(rows.buying_price)[24 + slot], np.asarray(rows.load)[24 + slot]
    expected = [f(price[1 : 1 + w]) for w in (3, 6, 12, 24) for f in (np.min, np.max, np.mean)]
    np.testing.assert_allclose(context.figures[slot, :12], expected)
    np.testing.assert_allclose(
        context.figures[slot, 16:20], [np.mean(load[1 : 1 + w]) for w in (3, 6, 12, 24)]
    )
    truth = world.joined().load[72 + slot + 1 : 72 + slot + 25]
    missed = np.sqrt(np.mean((np.asarray(rows.load)[slot, 1:25] - truth) ** 2))
    np.testing.assert_allclose(context.figures[slot, 25], missed / np.std(world.joined().load[:72]))


@pytest.mark.parametrize("model", SEEING, ids=lambda model: model.name)
def test_what_is_seen_does_not_know_the_future(model):
    """Change everything behind slot 10 of a day (and, where prices are published, behind its end)."""
    exogenous = noisy(8, 4)
    last = 96 + 23 if model.published else 96 + 10
    one, other = (outlook(traces) for traces in (exogenous, changed_after(exogenous, last)))
    for a, b in zip(*(jax.tree.leaves(seen(model, world)) for world in (one, other)), strict=True):
        np.testing.assert_allclose(a[:11], b[:11]) if a.ndim == 2 else np.testing.assert_array_equal(a, b)
    changed = [seen(model, world).figures[12:23] for world in (one, other)]
    if not model.published:
        assert not np.allclose(*changed)


@pytest.mark.parametrize("model", SEEING, ids=lambda model: model.name)
@pytest.mark.parametrize("days", [1, 4])
def test_in_a_world_that_repeats_itself_training_days_look_like_later_ones(model, days):
    exogenous = periodic(12)
    observer = Observer(model, hourly_means)
    training, test = cut(exogenous, 7 * 24)
    learned = observer.training_context(training, 24 * days, 1.0, weekdays(24 * days))
    later = observer.context(Outlook(training, test, 1.0, 36.0), weekdays(test.slots))
    np.testing.assert_allclose(learned.figures, later.figures[: 24 * days], atol=1e-9)
    np.testing.assert_allclose(learned.origins, later.origins[: 24 * days], atol=1e-9)


def test_a_forecast_of_training_days_has_not_seen_them():
    """Days 3 to 5 are changed: their own forecasts hardly notice, since they are fitted to the others."""
    exogenous = noisy(9, 5)
    other = replace(exogenous, load=np.where(np.arange(216) // 24 % 9 // 3 == 1, 50.0, exogenous.load))
    observer = Observer(MODELS["forecast"], hourly_means)
    one, two = (
        np.asarray(observer.training_forecast(traces, 216, 1.0, 25.0).load) for traces in (exogenous, other)
    )
    np.testing.assert_allclose(one[72:144, 1:], two[72:144, 1:])
    assert not np.allclose(one[:72, 1:], two[:72, 1:])


def test_published_prices_are_those_of_the_circle_in_training():
    """From 14:00 of the last day on, the prices of the first one are published."""
    exogenous = noisy(4, 6)
    observer = Observer(MODELS["published"], yesterday)
    rows = np.asarray(observer.training_forecast(exogenous, 72, 1.0, 25.0).buying_price)
    price = np.concatenate([exogenous.buying_price[:72], exogenous.buying_price[:72]])
    np.testing.assert_allclose(rows[48 + 14, :25], price[62 : 62 + 25])
    plain = PublishedPrices(yesterday)(Outlook(exogenous.window(0, 48), exogenous.window(48, 72), 1.0, 25.0))
    np.testing.assert_allclose(rows[48:58, :10], np.asarray(plain.buying_price)[:10, :10])
