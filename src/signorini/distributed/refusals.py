# SPDX-License-Identifier: BSD-3-Clause
"""What ranks do not solve, refused by name before a mesh is cut."""

from __future__ import annotations

from signorini.distributed.ranks import MUMPS, PETSC, the_team
from signorini.errors import InputError, Where
from signorini.model.model import Model


def refusal(found: str, expected: str, where: Where = ()) -> InputError:
    """What to say of something that ranks do not solve.

    Parameters
    ----------
    found : what it is
    expected : in its place
    where : its path in the model

    Examples
    --------
    >>> print(refusal("sides that wear", "no wear", ("contact", 0, "wear")))
    contact[0].wear: back end 'petsc' does not know sides that wear; expected no wear, or another back end
    """
    words = f"back end '{PETSC}' does not know {found}; expected {expected}, or another back end"
    return InputError(words, where=where)


def has_mumps() -> bool:
    """Whether PETSc was built with MUMPS."""
    from petsc4py import PETSc as Library

    return bool(Library.Sys.hasExternalPackage(MUMPS))


def refuse_without_mumps() -> None:
    """Refuse a PETSc that cannot factorise.

    Raises
    ------
    InputError
        If it was built without MUMPS.
    """
    if not has_mumps():
        words = "needs a PETSc that was built with MUMPS; expected one, as Debian's and conda-forge's are"
        raise InputError(f"back end '{MUMPS}' {words} (docs/distributed.md)")


def refuse_model(model: Model) -> None:
    """Refuse a machine without PETSc, and what needs more than the stiffness of elastic bodies, and pairs that stay.

    Raises
    ------
    InputError
        What is missing; or the first part of the model that is not known, by its name.
    """
    the_team()
    for i, body in enumerate(model.bodies):
        if body.material.yields:
            raise refusal(f"bodies that yield ('{body.name}')", "elastic bodies", ("body", i, "material"))
    for i, contact in enumerate(model.contacts):
        if contact.slides:
            raise refusal("contacts that slide far", "small slips", ("contact", i, "sliding"))
        if contact.wear is not None:
            raise refusal("sides that wear", "no wear", ("contact", i, "wear"))
