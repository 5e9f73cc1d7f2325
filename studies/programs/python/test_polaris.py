"""polaris, which has printed orders of convergence of 75.976 and NaN: such a table is no convergence, and does not pass."""
import math
import pytest

@pytest.mark.parametrize("last", [2**-75.976, math.nan, 0.0])
def test_no_order(convergence, last):
    with pytest.raises(AssertionError, match="error: (fail|inconclusive)"):
        convergence.assert_order([240, 120, 60], [4.0, 1.0, last], order=2)
