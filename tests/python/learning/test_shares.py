"""Shares of episodes and their intervals."""

import numpy as np
import pytest

from galactic.learning.reports.shares import interval, percent, percent_of


@pytest.mark.parametrize("count", [1, 7, 200])
def test_the_ends_of_an_interval_are_where_the_share_is_as_far_away_as_chance_leads(count):
    """Wilson's: |share - p| = z sqrt(p (1 - p) / n) at both ends p."""
    for successes in range(count + 1):
        share = successes / count
        for end in interval(share, count):
            away = 1.959963984540054 * np.sqrt(end * (1.0 - end) / count)
            np.testing.assert_allclose(abs(share - end), away, atol=1e-7)


def test_an_interval_has_the_rate_in_about_95_of_100_cases():
    draws, count, inside = np.random.default_rng(1), 100, 0
    rates = draws.uniform(0.05, 0.95, 4000)
    for rate in rates:
        low, high = interval(draws.binomial(count, rate) / count, count)
        inside += low <= rate <= high
    assert 0.935 < inside / len(rates) < 0.965


def test_it_is_told_in_percent():
    assert percent(378 / 400, 400) == "94.5 % (91.8 to 96.3)"
    assert percent_of(0.0, 1.0) == "0.0 % (0.0 to 79.3) of 1 episode"
    assert percent_of(1.0, 20) == "100.0 % (83.9 to 100.0) of 20 episodes"
    assert interval(0.0, 0) == (0.0, 1.0)
