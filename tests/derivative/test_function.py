# SPDX-License-Identifier: BSD-3-Clause
"""Prepared models as functions with derivatives, for optimisers and for programs that differentiate."""

import sys

import numpy as np
import pytest
from scipy.optimize import least_squares

import signorini as sg
from tests.derivative.rig import rig

INPUTS = ["friction.joint", "load.pull", "support.down", "E.block", "gap.joint", "interference.joint"]
OUTPUTS = [sg.pressure("joint").peak, sg.dissipation(), sg.displacement(0, along=(1.0, 0.0)).after(2)]


@pytest.fixture(scope="module")
def function():
    return sg.prepare(rig()).function(INPUTS, OUTPUTS)


def test_the_start_is_what_the_model_has(function):
    assert function.start[:4] == pytest.approx([0.35, 1.0, 1.0, 900.0])
    assert not function.start[4:].any()
    solution = sg.solve(rig())
    values = function.values(function.start)
    assert values[0] == pytest.approx(solution.contact("joint").pressure.max(), rel=1e-10)
    assert values[1] == pytest.approx(sum(step.dissipation for step in solution.steps), rel=1e-9)


def test_the_jacobian_is_that_of_the_function(function):
    x = function.start * 1.01
    x[4:-1] = 1e-5 * np.cos(np.arange(len(x) - 5))
    values, vjp = function(x)
    jacobian = function.jacobian(x)
    weights = np.array([0.3, 20.0, -100.0])
    assert vjp(weights) == pytest.approx(weights @ jacobian, rel=1e-8)
    assert not vjp(np.zeros(3)).any()
    sizes = np.concatenate([np.maximum(np.abs(x[:4]), 1e-3) * 1e-5, np.full(len(x) - 4, 1e-8)])
    for k in (0, 1, 2, 3, 5, len(x) - 1):
        step = sizes[k] * np.eye(len(x))[k]
        wanted = (function.values(x + step) - function.values(x - step)) / (2.0 * sizes[k])
        assert jacobian[:, k] == pytest.approx(wanted, rel=1e-6, abs=1e-7 * np.abs(values / x[0]).max())


def test_least_squares_of_scipy_takes_it():
    wanted = sg.prepare(rig(friction=0.41)).function(["friction.joint", "support.down"], OUTPUTS)
    target = wanted.values([0.41, 1.04])
    found = least_squares(
        lambda x: (wanted.values(x) - target) / target,
        [0.35, 1.0],
        jac=lambda x: wanted.jacobian(x) / target[:, None],
        xtol=1e-13,
    )
    assert found.x == pytest.approx([0.41, 1.04], rel=1e-9)
    assert found.nfev <= 8


def test_what_is_no_input_is_named():
    prepared = sg.prepare(rig())
    for inputs, words in (
        (["friction.hinge"], "no input that can change"),
        (["adhesion.joint"], "no input that can change"),
        (["weight.pad"], "kind of parameter"),
        (["friction"], r"kind\.name"),
    ):
        with pytest.raises(sg.InputError, match=words):
            prepared.function(inputs, OUTPUTS)
    f = prepared.function(["load.pull"], OUTPUTS)
    with pytest.raises(sg.InputError, match="has shape"):
        f([1.0, 2.0])
    with pytest.raises(sg.InputError, match="factor of 'pull' is 0"):
        f.jacobian([0.0])


@pytest.mark.parametrize("library", ["jax", "torch"])
def test_libraries_that_are_not_installed_are_named(monkeypatch, function, library):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(sg.InputError, match=f"'{library}' is not installed"):
        getattr(sg, library)(function)


def test_materials_under_loads_that_are_multiplied():
    """Temperatures are multiplied in the model, other loads beside it: neither twice."""
    f = sg.prepare(rig()).function(["load.heat", "load.pull", "nu.block"], OUTPUTS[:2])
    x, step = np.array([1.2, 0.9, 0.25]), 1e-5 * np.eye(3)[2]
    wanted = (f.values(x + step) - f.values(x - step)) / 2e-5
    assert f.jacobian(x)[:, 2] == pytest.approx(wanted, rel=1e-6, abs=1e-8)


@pytest.fixture(scope="module")
def small():
    """Few parameters, for checks that go through all of them several times."""
    return sg.prepare(rig()).function(["friction.joint", "support.down"], OUTPUTS[:2])


def test_jax_differentiates_it(function, small):
    jax = pytest.importorskip("jax", reason="JAX is an extra that is not installed")
    jax.config.update("jax_enable_x64", True)
    weights = np.array([1.0, 2.0, 3.0])
    gradient = jax.grad(lambda x: sg.jax(function)(x) @ weights)(jax.numpy.asarray(function.start))
    assert np.asarray(gradient) == pytest.approx(function(function.start)[1](weights), rel=1e-12)
    wrapped, x = sg.jax(small), jax.numpy.asarray(small.start)
    assert np.asarray(jax.jit(jax.jacrev(wrapped))(x)) == pytest.approx(small.jacobian(small.start), rel=1e-9)
    several = jax.vmap(wrapped)(jax.numpy.stack([x, 1.01 * x]))
    assert np.asarray(several[1]) == pytest.approx(small.values(1.01 * small.start), rel=1e-12)


def test_torch_differentiates_it(function, small):
    torch = pytest.importorskip("torch", reason="PyTorch is an extra that is not installed")
    x = torch.tensor(function.start, requires_grad=True)
    weights = torch.tensor([1.0, 2.0, 3.0], dtype=torch.float64)
    (sg.torch(function)(x) @ weights).backward()
    assert x.grad.numpy() == pytest.approx(function(function.start)[1](weights.numpy()), rel=1e-12)
    wrapped, few = sg.torch(small), torch.tensor(small.start, requires_grad=True)
    assert torch.autograd.gradcheck(wrapped, (few,), eps=1e-6, atol=1e-4, nondet_tol=1e-9)
    short = torch.tensor(small.start, dtype=torch.float32, requires_grad=True)
    answers = wrapped(short)
    answers.sum().backward()
    assert answers.dtype == short.grad.dtype == torch.float32
