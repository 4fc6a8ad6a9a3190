"""Metrics of very many vehicles as functions of PyTorch or JAX, with exact derivatives.

    metrics = torch_metrics(vehicle, ["supply.voltage", "friction.radius"], ["lift_mean", "power_electrical"])
    lift, power = metrics(designs).unbind(1)        # designs: a float64 tensor (designs, keys), SI
    (power - 2.0 * lift).sum().backward()           # designs.grad: through the orbits

A design that does not flap has NaN for each metric and derivatives of 0, so that `torch.where` or `jnp.where` leaves it
out of a sum and of its derivatives.
"""

import numpy as np
import wingbeat as wb


def _solved(designs, vehicle, keys, metrics, tolerance, slopes):
    columns = dict(zip(keys, np.array(designs, dtype=float).T))
    found = wb.solve(columns, vehicle=vehicle, tolerance=tolerance, metrics=metrics)
    values = np.stack([getattr(found, metric) for metric in metrics], axis=1)
    return (values, np.nan_to_num(found.gradient(metrics, keys))) if slopes else values


def torch_metrics(vehicle, keys, metrics, tolerance=1e-6):
    """A function of PyTorch from designs (designs, keys) to metrics (designs, metrics)."""
    import torch

    class Metrics(torch.autograd.Function):
        @staticmethod
        def forward(ctx, designs):
            values, slopes = _solved(designs.detach().cpu(), vehicle, keys, metrics, tolerance, True)
            ctx.save_for_backward(torch.from_numpy(slopes).to(designs))
            return torch.from_numpy(values).to(designs)

        @staticmethod
        def backward(ctx, wanted):
            (slopes,) = ctx.saved_tensors
            return torch.einsum("dm,dmk->dk", wanted, slopes)

    return Metrics.apply


def jax_metrics(vehicle, keys, metrics, tolerance=1e-6):
    """A function of JAX from designs (designs, keys) to metrics (designs, metrics), also under jit."""
    import jax
    import jax.numpy as jnp

    def solved(slopes):
        def of_designs(designs):
            found = _solved(designs, vehicle, keys, metrics, tolerance, slopes)
            return jax.tree_util.tree_map(lambda array: array.astype(designs.dtype), found)

        return of_designs

    def shaped(designs, *shape):
        return jax.ShapeDtypeStruct((designs.shape[0], *shape), designs.dtype)

    @jax.custom_vjp
    def of_designs(designs):
        return jax.pure_callback(solved(False), shaped(designs, len(metrics)), designs)

    def forward(designs):
        shapes = shaped(designs, len(metrics)), shaped(designs, len(metrics), len(keys))
        return jax.pure_callback(solved(True), shapes, designs)

    def backward(slopes, wanted):
        return (jnp.einsum("dm,dmk->dk", wanted, slopes),)

    of_designs.defvjp(forward, backward)
    return of_designs
