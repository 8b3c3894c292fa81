# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of a model by kind and name, and the change of each."""

from __future__ import annotations

import numpy as np

from signorini.derivative.body_changes import BodyChange
from signorini.derivative.body_side import BodySide
from signorini.derivative.changes import FrictionChange, GapChange, LoadChange
from signorini.derivative.moduli import ModulusChange
from signorini.derivative.modulus_pairs import ModulusPairs, with_material
from signorini.derivative.pair_change import between_bodies
from signorini.derivative.recursion import Change
from signorini.derivative.step_friction import coefficients
from signorini.engine.prepare import Prepared
from signorini.errors import InputError, one_of
from signorini.law.friction import Coulomb
from signorini.model.material import Elastic

KINDS = ("friction", "adhesion", "shear_limit", "interference", "load", "support", "E", "nu", "expansion")
"""Of parameters that are one number; gaps are given node by node."""

_STEP = 1e-5  # of Poisson's ratio, and of a modulus: K is smooth in both, differences right to a part in 1e9
_LAWS = ("friction", "adhesion", "shear_limit")


def names_of(prepared: Prepared, kind: str) -> list[str]:
    """Names that parameters of a kind go by.

    Raises
    ------
    InputError
        For another kind.
    """
    model = prepared.model
    if kind not in KINDS and kind != "gap":
        raise InputError(one_of(kind, [*KINDS, "gap"], "kind of parameter"))
    if kind in ("interference", "gap", *_LAWS):
        given = coefficients(model) if kind == "friction" else {}
        return [*(contact.label for contact in model.contacts if not contact.tied), *given]
    if kind == "load":
        return list(prepared.loads)
    if kind == "support":
        return list(prepared.constraints.prescribed)
    return [body.name for body in model.bodies if isinstance(body.material, Elastic)]


def change_of(prepared: Prepared, kind: str, name: str, seen: ModulusPairs) -> Change:
    """What a parameter changes at once.

    Parameters
    ----------
    prepared : the model
    kind, name : of the parameter
    seen : what moduli change of the pairs of the model

    Raises
    ------
    InputError
        For a parameter that there is not.
    """
    known = names_of(prepared, kind)
    if name not in known:
        raise InputError(one_of(name, known, f"{kind} of the model"))
    model = prepared.model
    if kind in _LAWS:
        return _friction(prepared, kind, name)
    if kind == "interference":
        labels = [contact.label for contact in model.contacts]
        return GapChange(gap=-1.0 * (prepared.interface.contact == labels.index(name)))
    if kind in ("load", "support"):
        return LoadChange(name=name)
    body = [part.name for part in model.bodies].index(name)
    if kind == "E" and ModulusChange.knows(prepared, body):
        return ModulusChange(prepared=prepared, body=body, seen=seen)
    material = model.bodies[body].material
    given = float(getattr(material, kind))
    step = _STEP if kind == "nu" else _STEP * (abs(given) or 1.0)
    low, high = (
        BodySide(
            prepared=prepared, model=with_material(model, body, **{kind: given + part}), space=prepared.space, body=body
        )
        for part in (-step, step)
    )
    return BodyChange(prepared=prepared, low=low, high=high, step=step, tilts=kind == "E" and between_bodies(model))


def given_value(prepared: Prepared, kind: str, name: str) -> float:
    """Value of a parameter as the model has it; 1 of loads and supports, NaN of what is not one number.

    Parameters
    ----------
    prepared : the model
    kind, name : of the parameter
    """
    model = prepared.model
    if kind in ("load", "support"):
        return 1.0
    if kind in ("E", "nu", "expansion"):
        return float(getattr(next(body.material for body in model.bodies if body.name == name), kind))
    if kind == "friction" and name in (steps := coefficients(model)):
        return steps[name]
    contact = next(contact for contact in model.contacts if contact.label == name)
    found = contact.constant_interference if kind == "interference" else getattr(contact, kind)
    return float(found) if isinstance(found, int | float) else np.nan


def _friction(prepared: Prepared, kind: str, name: str) -> FrictionChange:
    """A parameter of the friction of a contact.

    Raises
    ------
    InputError
        Where the contact has none that could change.
    """
    model, labels = prepared.model, [contact.label for contact in prepared.model.contacts]
    if kind == "friction" and name in coefficients(model):
        return FrictionChange(parameter=kind, contact=labels.index(name.rpartition("@")[0]), coefficient=name)
    number = labels.index(name)
    law = model.contacts[number].law
    if not isinstance(law, Coulomb) or isinstance(law.friction, tuple) or callable(law.friction):
        raise InputError(f"the friction of contact '{name}' is not one number")
    if kind == "shear_limit" and law.shear_limit is None:
        raise InputError(f"contact '{name}' has no shear limit")
    if kind == "adhesion" and not law.adhesion:
        raise InputError(f"contact '{name}' has no adhesion")
    if kind == "friction" and not np.isfinite(law.coefficient):
        raise InputError(f"contact '{name}' sticks whatever its friction")
    return FrictionChange(parameter=kind, contact=number)


def split(parameter: str) -> tuple[str, str]:
    """Kind and name of a parameter.

    >>> split("friction.foundation")
    ('friction', 'foundation')
    """
    kind, dot, name = parameter.partition(".")
    if not dot:
        raise InputError(f"is '{parameter}'; expected kind.name, 'friction.contact' or 'E.body'", where=("parameter",))
    return kind, name
