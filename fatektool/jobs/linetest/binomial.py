"""Limits of an error rate, from the number of errors in a test (Clopper and Pearson, 1934)."""

from __future__ import annotations

from math import exp, lgamma, log, log1p
from typing import Final

_TINY: Final = 1e-300
_STEPS: Final = 20_000
_EPSILON: Final = 1e-14


def upper_bound(errors: int, trials: int, confidence: float = 0.95) -> float:
    """The highest error rate that still agrees with what was seen, at this one-sided confidence.

    Exact: the rate at which so few errors come by chance with probability ``1 - confidence``. With no error
    in 1000 trials it is 0.0030.

    Args:
        errors: 0 to ``trials``.
        trials: how many; with none, nothing is known, and the bound is 1.
        confidence: 0 to 1, both excluded.
    """
    if errors >= trials:
        return 1.0
    low, high = errors / trials, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        if at_most(errors, trials, middle) > 1 - confidence:
            low = middle
        else:
            high = middle
    return high


def at_most(errors: int, trials: int, rate: float) -> float:
    """The probability of at most so many errors in so many trials at this rate."""
    if errors >= trials or rate <= 0:
        return 1.0
    if rate >= 1:
        return 0.0
    return 1 - _incomplete_beta(errors + 1, trials - errors, rate)


def at_least(errors: int, trials: int, rate: float) -> float:
    """The probability of at least so many errors in so many trials at this rate."""
    return 1.0 if errors <= 0 else _incomplete_beta(errors, trials - errors + 1, rate) if rate < 1 else 1.0


def _incomplete_beta(a: float, b: float, x: float) -> float:
    """The regularised incomplete beta function I_x(a, b), by its continued fraction (Lentz's method)."""
    if x <= 0:
        return 0.0
    if x > (a + 1) / (a + b + 2):  # the fraction converges fast on the other side
        return 1 - _incomplete_beta(b, a, 1 - x)
    front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) + a * log(x) + b * log1p(-x)) / a
    numerator, denominator, result = 1.0, 0.0, 1.0
    for step in range(_STEPS):
        m = step // 2
        if step == 0:
            term = 1.0
        elif step % 2 == 0:
            term = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        else:
            term = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        denominator = 1 / (1 + term * denominator or _TINY)
        numerator = 1 + term / numerator or _TINY
        result *= numerator * denominator
        if abs(1 - numerator * denominator) < _EPSILON:
            break
    return front * (result - 1)
