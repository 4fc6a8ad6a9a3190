"""The example that makes metrics differentiable functions of PyTorch. JAX is not among Debian's packages."""

import importlib.util
import sys
import unittest

import numpy as np
import wingbeat as wb
from shared import DATA

sys.path.insert(0, str(DATA.parent / "examples" / "python"))
import learning


class Derivatives(unittest.TestCase):
    KEYS = ["supply.voltage", "friction.radius"]
    METRICS = ["lift_mean", "power_electrical"]

    def setUp(self):
        self.vehicle = wb.read(DATA / "designs" / "friction2022-springs.toml")

    def test_designs_that_do_not_flap_have_slopes_of_zero(self):
        designs = np.array([[0.2, 2.5e-3], [4.0, 2.5e-3]])
        values, slopes = learning._solved(designs, self.vehicle, self.KEYS, self.METRICS, 1e-6, True)
        self.assertTrue(np.isnan(values[0]).all() and np.isfinite(values[1]).all())
        self.assertTrue((slopes[0] == 0.0).all() and (slopes[1] != 0.0).all())

    @unittest.skipUnless(importlib.util.find_spec("torch"), "PyTorch is not installed")
    def test_pytorch(self):
        import torch

        size = torch.tensor([4.0, 2.5e-3], dtype=torch.float64)
        metrics = learning.torch_metrics(self.vehicle, self.KEYS, self.METRICS, 1e-11)
        share = torch.tensor([[0.9, 1.0], [1.0, 0.8]], dtype=torch.float64, requires_grad=True)
        self.assertTrue(torch.autograd.gradcheck(lambda u: metrics(u * size), (share,), eps=1e-4, atol=1e-6, rtol=1e-6))
        lift, power = metrics(share * size).unbind(1)
        (power - 2.0 * lift).sum().backward()
        self.assertTrue(torch.isfinite(share.grad).all() and (share.grad != 0.0).all())


if __name__ == "__main__":
    unittest.main()
