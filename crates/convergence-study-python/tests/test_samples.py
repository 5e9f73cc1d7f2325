"""Studies whose levels are made of samples."""

import copy
import math
import pickle
import random

import pytest

import convergence_study as cs


def errors(n, seed):
    """A strong error of order one half, and a signed weak one of order one."""
    draw = random.Random(f"0 {n} {seed}").gauss
    h = 1 / n
    return {"strong": math.sqrt(h) * abs(1 + 0.3 * draw(0, 1)), "weak": h * (1 + 0.3 * draw(0, 1))}


LEVELS = {"n": [4, 8, 16, 32, 64], "samples": 40}
ORDERS = {"strong": 0.5, "weak": 1}


def test_samples_are_judged_by_their_scatter():
    seeds = []

    def solve(n, seed):
        seeds.append((n, seed))
        return errors(n, seed)

    study = cs.study(solve, order=ORDERS, of={"weak": "weak"}, **LEVELS)
    study.assert_passes()
    assert seeds == [(n, seed) for n in LEVELS["n"] for seed in range(1, 41)]
    assert "each level is made of 40 samples, by the same seeds on all levels" in study.summary
    mean = sum(errors(64, seed)["strong"] for seed in range(1, 41)) / 40
    assert study.table()["strong"][4] == pytest.approx(mean)
    # The order of the levels is that of their steps.
    again = cs.study(errors, n=[16, 64, 4, 32, 8], samples=40, order=ORDERS, of={"weak": "weak"})
    assert again.rates["weak"].rate == study.rates["weak"].rate
    for other in (pickle.loads(pickle.dumps(study)), copy.copy(study)):
        assert other.verdict == "pass" and other.rates["strong"].interval == study.rates["strong"].interval


def test_the_interval_is_that_of_samples():
    study = cs.study(errors, order=ORDERS, of={"weak": "weak"}, **LEVELS)
    text = "n,seed,strong\n" + "".join(
        f"{n},{seed},{errors(n, seed)['strong']!r}\n" for n in LEVELS["n"] for seed in range(1, 41)
    )
    found = cs.rates(text, order=0.5, dim=1, samples="mean")["rates"][0]
    assert tuple(found["interval"]) == pytest.approx(study.rates["strong"].interval)


def test_wrong_orders_and_levels_that_are_lost_in_their_scatter_do_not_pass():
    assert cs.study(errors, order={"strong": 1}, **LEVELS).verdict == "fail"
    assert cs.study(errors, order={"weak": 2}, of="weak", **LEVELS).verdict == "fail"
    # As a mean of sizes a signed error is none.
    signed = cs.study(lambda n, seed: (-1) ** seed / n, order=1, **LEVELS)
    assert signed.verdict == "fail" and "negative" in str(signed)
    lost = cs.study(lambda n, seed: 1 / n + random.Random(f"{n} {seed}").gauss(0, 1), order=1, of="weak", **LEVELS)
    assert lost.verdict == "inconclusive" and "samples would" in str(lost)


def test_what_samples_do_not_have_is_refused():
    for options, message in [
        ({"samples": 9}, "samples: expected a whole number >= 10, found 9"),
        ({"samples": True}, "samples: expected a whole number >= 10, found True"),
        ({"of": "weak"}, "of: expected only with samples, found 'weak'"),
        ({"samples": 10, "of": "median"}, "of: expected one of mean, rms, weak, found 'median'"),
        ({"samples": 10, "floor": 1e-9}, "floor: expected none beside samples"),
        ({"samples": 10, "of": {"wek": "weak"}}, "of: expected the names of errors that solve returns, found `wek`"),
        ({"samples": 10, "n": "auto"}, "samples: expected levels"),
    ]:
        with pytest.raises(ValueError, match=message):
            cs.study(errors, **{"n": [4, 8, 16], "order": 1, **options})
    steps = lambda n, seed: {"h": 1 / n + seed, "error": 1 / n}  # noqa: E731
    with pytest.raises(ValueError, match="expected one step for all samples of a level"):
        cs.study(steps, order=1, **LEVELS)


def test_the_fixture_takes_samples(convergence):
    assert convergence.study(errors, order=ORDERS, of={"weak": "weak"}, **LEVELS).verdict == "pass"
