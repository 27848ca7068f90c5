"""Colour ranges: where they end, how they move, which colours stand for what, what the bar says."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.app.colouring.colour_bar import ticks
from workbench.app.colouring.colour_legend import note_of
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.colouring.range_fit import rounded_down, rounded_factor, rounded_up
from workbench.app.quantities.formula_dialog import values_in
from workbench.app.quantities.quantities import (
    CONFORMAL_FACTOR,
    FACTORS,
    LIVE_QUANTITIES,
    quantity_of_distortion,
    quantity_of_formula,
)
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.registry import registry

DETERMINANT = next(q for q in FACTORS if q.id == "det")


@pytest.mark.parametrize(("span", "expected"), [(0.11, 0.2), (1.0, 1.0), (1.2, 2.0), (4.9, 5.0), (5.1, 10.0), (730, 1000)])
def test_ranges_end_at_round_numbers(span: float, expected: float) -> None:
    assert rounded_up(span) == pytest.approx(expected)


def test_a_range_rises_at_once_and_falls_late(qapp: object) -> None:
    colour_range = ColourRange(LIVE_QUANTITIES[2])
    colour_range.take(np.full(100, 5.5, np.float32))
    assert (colour_range.low, colour_range.high) == (4.0, 6.0)
    colour_range.take(np.full(100, 20.0, np.float32))
    assert colour_range.high == 24.0
    colour_range.take(np.full(100, 10.0, np.float32))
    assert colour_range.high == 24.0, "colours keep their meaning while values wander"
    colour_range.take(np.full(100, 4.2, np.float32))
    assert colour_range.high < 5.0
    colour_range.hold(True)
    colour_range.take(np.full(100, 400.0, np.float32))
    assert colour_range.high < 5.0


@pytest.mark.parametrize(("value", "high"), [(20.0, 24.0), (17.0, 24.0), (13.0, 14.0), (8.0, 9.0)])
def test_where_nothing_runs_most_of_the_scale_is_in_use(value: float, high: float, qapp: object) -> None:
    colour_range = ColourRange(LIVE_QUANTITIES[2])
    colour_range.take(np.full(100, 20.0, np.float32))
    values = np.full(100, value, np.float32)
    colour_range.take(values)
    assert colour_range.high == 24.0
    colour_range.take(values, at_rest=True)
    assert colour_range.high == high


def test_values_that_are_not_finite_do_not_count(qapp: object) -> None:
    colour_range = ColourRange(LIVE_QUANTITIES[0])
    values = np.ones(100, np.float32)
    values[:10] = np.inf
    values[10:20] = np.nan
    colour_range.take(values)
    assert np.isfinite(colour_range.high)
    colour_range.take(np.full(5, np.nan, np.float32))
    assert np.isfinite(colour_range.high)


@pytest.mark.parametrize("value", [0.013, 0.2, 0.93, 1.0, 7.1, 730.0])
def test_rounding_encloses(value: float) -> None:
    assert rounded_down(value) <= value * (1 + 1e-9) and value <= rounded_up(value) * (1 + 1e-9)
    if value >= 1:
        assert value <= rounded_factor(value) * (1 + 1e-9) <= 2.6 * value


def test_factors_reach_equally_far_below_and_above_one(qapp: object) -> None:
    colour_range = ColourRange(CONFORMAL_FACTOR)
    colour_range.take(np.linspace(0.55, 1.1, 100, dtype=np.float32))
    assert colour_range.low * colour_range.high == pytest.approx(1.0)
    assert colour_range.low <= 0.56
    assert colour_range.share_of(1.0) == pytest.approx(0.5)
    far = colour_range.high
    colour_range.take(np.linspace(0.7, 1.4, 100, dtype=np.float32))
    assert colour_range.high == far, "colours keep their meaning while values wander"
    colour_range.take(np.linspace(0.97, 1.02, 100, dtype=np.float32))
    assert colour_range.high == pytest.approx(1.05)


@pytest.mark.parametrize("ends", [(0.8, 4.0), (0.25, 1.25), (1.5, 3.0)])
def test_the_centre_has_the_middle_colour_where_sides_are_unequal(ends: tuple[float, float], qapp: object) -> None:
    colour_range = ColourRange(CONFORMAL_FACTOR)
    colour_range.set_ends(*ends)
    colours = colour_range.colours(2001)
    middle = ColourRange(CONFORMAL_FACTOR).colours(3)[1]
    share = colour_range.share_of(1.0)
    if 0 < share < 1:
        np.testing.assert_allclose(colours[round(2000 * share)], middle, atol=0.02)
    # equal factors on the two sides are equally far from the middle on the scale
    for factor in (1.1, 1.2):
        places = [colour_range.share_of(f) - share for f in (factor, 1 / factor)]
        assert places[0] == pytest.approx(-places[1])
    blue_less_red = colours[:, 2] - colours[:, 0]
    assert (np.diff(blue_less_red) <= 0.02).all(), "from blue to red, without a jump back"


def test_signed_values_are_centred_at_nothing(qapp: object) -> None:
    quantity = quantity_of_formula("log(det)")
    assert quantity.centre == 0.0 and quantity.least is None
    colour_range = ColourRange(quantity)
    colour_range.take(np.linspace(-0.2, 3.0, 100, dtype=np.float32))
    assert colour_range.low == -colour_range.high == -5.0


def test_every_distortion_begins_at_its_least_value() -> None:
    known = registry().distortions
    least = {id: quantity_of_distortion(known[id]).least for id in known}
    expected_ones = {"symmetric-dirichlet": 4.0, "dirichlet": 0.0, "condition-number": 1.0, "mips": 2.0, "arap": 0.0}
    for id, expected in expected_ones.items():
        assert least[id] == pytest.approx(expected), id
    assert all(value is not None and value >= 0 for value in least.values())


def test_what_lies_beyond_the_ends_is_noted(qapp: object) -> None:
    colour_range = ColourRange(LIVE_QUANTITIES[2])
    values = np.full(1000, 4.5, np.float32)
    values[:12] = 100.0
    values[0] = np.inf
    colour_range.set_ends(4.0, 6.0)
    assert note_of(colour_range) == ""
    colour_range.take(values)
    assert note_of(colour_range) == "1.2 % above"
    colour_range.fit(whole=True)
    assert colour_range.high >= 100.0 and note_of(colour_range) == "0.1 % above", "infinity is beyond every end"
    factor = ColourRange(CONFORMAL_FACTOR)
    factor.set_ends(0.5, 2.0)
    factor.take(np.array([0.1, 1.0, 1.0, 3.0], np.float32))
    assert note_of(factor) == "25 % below, 25 % above"


def test_ends_that_are_none_are_refused_with_a_sentence(qapp: object) -> None:
    colour_range = ColourRange(CONFORMAL_FACTOR)
    before = colour_range.low, colour_range.high
    for ends in ((2.0, 1.0), (float("nan"), 1.0), (0.0, 2.0), (-1.0, 2.0)):
        with pytest.raises(ValueError, match=r"must be|begins above"):
            colour_range.set_ends(*ends)
    assert (colour_range.low, colour_range.high) == before and not colour_range.is_locked
    colour_range.set_ends(0.1, 3.0)
    colour_range.take(np.full(50, 80.0, np.float32))
    assert (colour_range.low, colour_range.high) == (0.1, 3.0)
    colour_range.hold(False)
    assert colour_range.high >= 80.0


def test_scales_and_colours_can_be_turned(qapp: object) -> None:
    colour_range = ColourRange(LIVE_QUANTITIES[2])
    colour_range.take(np.geomspace(4.0, 900.0, 500).astype(np.float32))
    linear = colour_range.value_at(0.5)
    colour_range.set_logarithmic(True)
    assert colour_range.value_at(0.5) == pytest.approx((colour_range.low * colour_range.high) ** 0.5) and linear > 100
    forwards = colour_range.colours()
    colour_range.set_reversed(True)
    np.testing.assert_array_equal(colour_range.colours(), forwards[::-1])
    dirichlet = ColourRange(LIVE_QUANTITIES[0])
    dirichlet.take(np.linspace(0.01, 9.0, 100, dtype=np.float32))
    dirichlet.set_logarithmic(True)
    assert 0 < dirichlet.low < dirichlet.high


def test_marks_of_the_bar_are_its_ends_and_its_centre(qapp: object) -> None:
    sequential = ColourRange(LIVE_QUANTITIES[1])
    sequential.set_ends(1.0, 3.0)
    assert ticks(sequential)[:2] == [(1.0, "≥ 3"), (0.0, "1")]
    centred = ColourRange(DETERMINANT)
    centred.set_ends(0.5, 4.0)
    marks = ticks(centred)
    assert marks[:2] == [(1.0, "≥ 4"), (0.0, "≤ 0.5")]
    assert marks[2] == (pytest.approx(1 / 3), "1")
    assert all(-1e-9 <= share <= 1 + 1e-9 for share, _ in marks)


def test_one_range_a_quantity_and_formulas_join_the_book(qapp: object) -> None:
    book = QuantityBook()
    book.list_distortions(registry().distortions.values())
    ids = [quantity.id for quantity in book.quantities]
    assert len(ids) == len(set(ids)) and set(registry().distortions) <= set(ids)
    assert book.range_of("det") is book.range_of("det")
    changed: list[str] = []
    book.range_changed.connect(changed.append)
    book.range_of("det").set_ends(0.5, 3.0)
    assert changed == ["det"] * len(changed) and changed
    formula = book.add_formula(" t*sigma1 ", {"t": 2.0})
    assert formula.measure.parameters == (("t", 2.0),) and formula.id in book
    assert book.add_formula("det").id == "det" and book.add_formula("mips").id == "mips"
    book.list_distortions(registry().distortions.values())
    assert formula.id in book
    with pytest.raises(WorkbenchError):
        book.add_formula("sigma1 +")


def test_a_formula_that_is_redefined_takes_its_range_along(qapp: object) -> None:
    book = QuantityBook()
    own = [Distortion("mine", "Mine", "sum(sigma^2)")]
    book.list_distortions(own, own=["mine"])
    colour_range = book.range_of("mine")
    assert book["mine"].group == "own" and colour_range.quantity.least == 0.0
    book.list_distortions([Distortion("mine", "Mine", "7 + log(det)")], own=["mine"])
    assert book.range_of("mine") is colour_range and colour_range.quantity.least is None
    book.list_distortions([])
    assert "mine" not in book and book.range_of("mine") is colour_range, "a view that shows it lives on"


def test_parameters_are_read_from_text() -> None:
    assert values_in("p = 4; t=0.5,") == {"p": 4.0, "t": 0.5}
    assert values_in("  ") == {}
    for text in ("p", "p = x", "= 3", "2p = 3"):
        with pytest.raises(WorkbenchError, match="name = value"):
            values_in(text)


def test_quantities_begin_where_those_of_the_dimension_do() -> None:
    book = QuantityBook()
    book.list_distortions(registry().distortions.values())
    symmetric = book.range_of("symmetric-dirichlet")
    assert (symmetric.quantity.least, symmetric.low) == (4.0, 4.0)
    book.add_formula("sum(sigma^2)/n")
    gone = book.add_formula("sigma1/sigma2").id
    book.set_dimension(3)
    symmetric.take(np.array([6.1, 6.5, 7.0]))
    assert (symmetric.quantity.least, symmetric.low) == (6.0, 6.0)
    assert "σ₃" in book["dirichlet"].formula
    assert book["mips"].least == pytest.approx(3.0)
    assert {"sum(sigma^2)/n", gone} <= {q.id for q in book.quantities}
    book.set_dimension(2)
    assert symmetric.quantity.least == 4.0


def test_what_a_dimension_does_not_have_is_replaced_where_it_is_shown() -> None:
    book = QuantityBook()
    book.list_distortions(registry().distortions.values())
    book.set_dimension(3)
    of_space = book.add_formula("sigma1/sigma3").id
    book.range_of(of_space)
    told: list[tuple[str, str]] = []
    book.replaced.connect(lambda old, new: told.append((old, new)))
    book.set_dimension(2)
    assert of_space not in book
    assert told == [(of_space, "in-force")]
