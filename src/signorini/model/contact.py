# SPDX-License-Identifier: BSD-3-Clause
"""Where bodies may touch, and the law there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from signorini.arrays import Array
from signorini.checks import choice, number, refuse_beside, text, vector, whole
from signorini.errors import InputError, Where
from signorini.law.closure import Closure
from signorini.law.cohesion import Cohesion
from signorini.law.friction import Coulomb, FrictionLaw
from signorini.model.mesh import Mesh
from signorini.model.obstacle import Obstacle
from signorini.model.varying import Varying, varying
from signorini.model.wear import Wear

COUPLINGS = ("auto", "nodes", "mortar", "node-to-segment")


@dataclass(frozen=True)
class Contact:
    """Two surfaces that may touch, or a surface and a rigid obstacle.

    ``gap >= 0``, ``pressure >= 0``, ``gap * pressure = 0`` and ``|traction| <= friction * pressure``, opposed to the
    slip increment where it is equal; where the sides touch with adhesion or a shear limit ``|traction| <=
    min(adhesion + friction * pressure, shear_limit)``, and nothing where they are open.

    Parameters
    ----------
    nonmortar : boundary whose nodes carry the pairs, the pressures and the results
    mortar : boundary of the other body; a rigid :class:`Plane`, :class:`Circle`, :class:`Profile`, :class:`Surface` or
        other shape at rest; or the name of a :class:`Rigid` obstacle of the model
    friction : Coulomb's coefficient, >= 0; "stick": never slips (it may still open); "tied": neither slips nor
        opens, nor presses initial gaps, which count as filled; or a function of the points (k, d) that gives the
        coefficients (k,), such as :class:`Along`. In space also two coefficients, along ``friction_axis`` and across:
        tractions lie in an ellipse then, and slip is normal to it. Or a law of its own, a :class:`FrictionLaw`
    shear_limit : largest traction of friction, force per area, > 0: Coulomb's law with a limit, or Tresca's law with
        friction = "stick"; None (default) is no limit
    adhesion : traction that friction holds without pressure, force per area, >= 0; lost where the sides open
    gap : "geometry"; "zero"; or the initial gap, length (negative: overlap), a number or what varies over the side,
        such as :class:`Formula`
    interference : overlap that is added to it, length, positive presses the bodies together; a number, or what varies:
        a crown of depth c(x) that the mesh has not is an interference of -c(x)
    normal_compliance, tangential_compliance : of the interface, length per pressure; 0 (default) is the exact law,
        ``1 / E_n`` and ``1 / E_tau`` the paper's penalties or a physical contact stiffness
    closure : what lies between the sides, a gasket, a coating or roughness: pressure over closure in place of a
        ``normal_compliance``; None (default): nothing
    cohesion : a bond of sides that touch at the beginning, which bears tension up to a limit; None (default): none
    name : what results call it; the nonmortar side by default
    coupling : how the sides see each other. "nodes": node opposite node, for meshes that match; "mortar": integrals
        over both sides, for any meshes; "node-to-segment": nodes on the facets opposite, simple and less accurate;
        "auto": nodes where linear meshes match (in space face opposite face), otherwise mortar
    side : which side is the nonmortar one: "named", as given here, or "coarser", the one with the longer facets (with
        "mortar" its pressures are the smoother ones)
    friction_axis : in space, direction (3,) of the first tangents, projected on the surface, along which the first of
        two coefficients acts; by default a coordinate axis
    facets : in space, corners of a polygon inscribed in the section of the friction cone, which it stands for, the
        first on the first tangent: a multiple of 4; 0 for the exact cone
    search : how far apart facets can be and still be opposite each other, length; by default half the size of the
        smaller side
    adjust : initial gaps up to this length are closed, and overlaps removed; None leaves them
    wear : how sliding wears the sides; None (default): not at all
    sliding : how far the sides slide over each other: "small", a fraction of a facet, so that what is opposite a node
        stays there, or "finite", any distance: pairs follow the bodies

    Examples
    --------
    >>> from signorini.model.obstacle import Plane
    >>> Contact("arc", Plane((0, 0), (0, 1)), friction=0.4).label
    'arc'
    """

    nonmortar: str
    mortar: str | Obstacle
    friction: float | tuple[float, float] | Literal["stick", "tied"] | Callable[[Array], Array] | FrictionLaw = 0.0
    shear_limit: float | None = None
    adhesion: float = 0.0
    gap: Varying | Literal["geometry", "zero"] = "geometry"
    interference: Varying = 0.0
    normal_compliance: float = 0.0
    tangential_compliance: float = 0.0
    name: str = ""
    coupling: Literal["auto", "nodes", "mortar", "node-to-segment"] = "auto"
    side: Literal["named", "coarser"] = "named"
    search: float | None = None
    adjust: float | None = None
    friction_axis: tuple[float, float, float] | None = None
    facets: int = 0
    wear: Wear | None = None
    sliding: Literal["small", "finite"] = "small"
    closure: Closure | None = None
    cohesion: Cohesion | None = None

    def __post_init__(self) -> None:
        text(self.nonmortar, ("nonmortar",))
        if not isinstance(self.mortar, Obstacle):
            text(self.mortar, ("mortar",))
        self._check_law()
        self._check_cone()
        if not isinstance(self.gap, str) or self.gap not in ("geometry", "zero"):
            object.__setattr__(self, "gap", self._given_gap())
        for key in ("normal_compliance", "tangential_compliance"):
            object.__setattr__(self, key, number(getattr(self, key), (key,), least=0.0))
        checked = number if isinstance(self.interference, float | int) else varying
        object.__setattr__(self, "interference", checked(self.interference, ("interference",)))
        choice(self.coupling, COUPLINGS, ("coupling",), "coupling")
        choice(self.side, ("named", "coarser"), ("side",), "side")
        choice(self.sliding, ("small", "finite"), ("sliding",), "sliding")
        if self.search is not None:
            object.__setattr__(self, "search", number(self.search, ("search",), above=0.0))
        if self.adjust is not None:
            object.__setattr__(self, "adjust", number(self.adjust, ("adjust",), least=0.0))
        if isinstance(self.mortar, Obstacle):
            self.check_alone()
        if self.tied:
            for key in ("interference", "normal_compliance", "tangential_compliance"):
                if getattr(self, key) != 0.0:
                    raise InputError("is given, but a tied contact is neither pressed nor compliant", where=(key,))
        if self.adjust is not None and self.gap != "geometry":
            raise InputError("goes with gap = 'geometry' only", where=("adjust",))
        if self.wear is not None:
            self._check_wear(self.wear)
        if self.closure is not None:
            self._check_closure(self.closure)
        if self.cohesion is not None:
            self._check_cohesion(self.cohesion)
        if self.sliding == "finite":
            self._check_sliding()

    def _given_gap(self) -> Varying:
        """An initial gap that is not that of the geometry."""
        try:
            return varying(self.gap, ("gap",))
        except InputError as error:
            if not isinstance(self.gap, str):
                raise
            words = "expected 'geometry', 'zero', a number or a formula"
            raise InputError(f"is '{self.gap}'; {words}: {error.message}", where=("gap",)) from error

    def _check_wear(self, wear: Wear) -> None:
        """What wears slides, by friction that does work where the law is one of energy."""
        if not isinstance(wear, Wear):
            raise InputError(f"is {wear!r}; expected a Wear", where=("wear",))
        if self.friction in ("stick", "tied"):
            words = "is tied" if self.tied else "never slips"
            raise InputError(f"is given, but the contact {words}, and nothing wears", where=("wear",))
        if wear.by_energy and self.friction == 0.0 and self.adhesion == 0.0:
            raise InputError(
                "goes by the work of friction, and the contact has none; expected a coefficient",
                where=("wear", "energy"),
            )

    def _check_closure(self, closure: Closure) -> None:
        """What lies between sides closes by one law."""
        if not isinstance(closure, Closure):
            raise InputError(f"is {closure!r}; expected a Closure", where=("closure",))
        refuse_beside(
            "closure",
            (self.tied, "the contact is tied"),
            (self.normal_compliance != 0.0, "normal_compliance too"),
        )

    def _check_cohesion(self, cohesion: Cohesion) -> None:
        """What is bonded neither wears nor slides far, and rubs by Coulomb's law alone once the bond is gone."""
        if not isinstance(cohesion, Cohesion):
            raise InputError(f"is {cohesion!r}; expected a Cohesion", where=("cohesion",))
        other = not self.coulomb or isinstance(self.friction, tuple)
        refuse_beside(
            "cohesion",
            (self.tied, "the contact is tied"),
            (self.closure is not None, "a closure too"),
            (self.wear is not None, "the contact wears"),
            (self.sliding == "finite", "the sides slide far"),
            (self.adhesion != 0.0 or self.shear_limit is not None, "adhesion or a shear limit too"),
            (other, "friction is not Coulomb's with one coefficient"),
        )

    def _check_sliding(self) -> None:
        """What goes with sides that slide far: gaps are those of the sides where they are."""
        finite = 'is "finite", but'
        if self.tied:
            raise InputError(f"{finite} a tied contact does not slide", where=("sliding",))
        if self.coupling in ("nodes", "node-to-segment"):
            words = f"{finite} coupling is '{self.coupling}'; expected 'mortar', or 'auto', which is mortar here"
            raise InputError(words, where=("sliding",))

    def _check_law(self) -> None:
        """What a law of friction says of itself, and what goes with it."""
        law = self.law
        if isinstance(law, Coulomb):
            for key in ("friction", "shear_limit", "adhesion"):
                object.__setattr__(self, key, getattr(law, key))
        for key in ("shear_limit", "adhesion"):
            if not getattr(self, key):
                continue
            if not isinstance(law, Coulomb):
                raise InputError(f"is given, but friction has a law of its own, {law.title()}", where=(key,))
            if self.tied or (self.friction == "stick" and key == "adhesion"):
                words = "is tied" if self.tied else "never slips"
                raise InputError(f"is given, but the contact {words}, whatever its friction holds", where=(key,))

    def _check_cone(self) -> None:
        """What a friction cone in space has."""
        if self.friction_axis is not None:
            axis = vector(self.friction_axis, ("friction_axis",), dimension=3)
            if not any(axis):
                raise InputError("is zero; expected a direction", where=("friction_axis",))
            object.__setattr__(self, "friction_axis", axis)
        elif isinstance(self.friction, tuple):
            raise InputError(
                "has two coefficients; expected friction_axis too, the direction of the first", where=("friction",)
            )
        if whole(self.facets, ("facets",), least=0) % 4:
            raise InputError(f"is {self.facets}; expected a multiple of 4, or 0 for the exact cone", where=("facets",))
        if self.facets and self.tied:
            raise InputError(f"is {self.facets}, but a tied contact has no friction cone", where=("facets",))

    @property
    def constant_interference(self) -> float:
        """The interference, length, that steps may change; 0 where it varies over the side and stays as it is."""
        return self.interference if isinstance(self.interference, float) else 0.0

    def check_pressed(self, where: Where) -> None:
        """Refuse another interference, asked for at ``where``, in place of one that varies over the side."""
        if not isinstance(self.interference, float):
            raise InputError("changes one that varies over the side; expected one that is a number", where=where)

    def check_bodies(self, yielding: Sequence[str]) -> None:
        """What goes with bodies some of which yield, by name.

        Raises
        ------
        InputError
            If the contact wears.
        """
        if self.wear is not None and yielding:
            raise InputError(
                f"is given, but '{yielding[0]}' yields; expected elastic bodies where sides wear", where=("wear",)
            )

    def check_meshed(self, *, linked: bool) -> None:
        """What goes with a mesh some of whose parts bolts or cyclic symmetries link.

        Raises
        ------
        InputError
            If the mesh is to move with what is worn.
        """
        if linked and self.wear is not None and self.wear.move_mesh is not None:
            words = "is given, but bolts or cyclic symmetries link parts of the mesh; expected a mesh that stays"
            raise InputError(words, where=("wear", "move_mesh"))

    def check_plane(self) -> None:
        """What goes with a plane model.

        Raises
        ------
        InputError
            If something is given that is for models in space.
        """
        space = "which is for models in space (kind = '3d')"
        if isinstance(self.friction, tuple):
            raise InputError(f"has two coefficients, {space}; expected one", where=("friction",))
        if self.friction_axis is not None:
            raise InputError(f"is {self.friction_axis}, {space}; expected none", where=("friction_axis",))
        if self.facets:
            raise InputError(f"is {self.facets}, {space}; expected none", where=("facets",))

    def check_alone(self) -> None:
        """What goes with a rigid obstacle.

        Raises
        ------
        InputError
            If something is given that is for two meshed sides.
        """
        for key, usual in (("coupling", "auto"), ("side", "named"), ("search", None)):
            if getattr(self, key) != usual:
                raise InputError(
                    f"is {getattr(self, key)!r}; that is for two meshed sides, and the other is a rigid obstacle",
                    where=(key,),
                )
        if self.wear is not None and self.wear.mortar:
            raise InputError(
                f"is {self.wear.mortar:g}, but the other side is a rigid obstacle, which does not wear; expected 0",
                where=("wear", "mortar"),
            )

    def check_exact(self, where: Where, *, in_space: bool) -> None:
        """What goes with an exact path: straight branches of friction, and in space no smooth section.

        Parameters
        ----------
        where : the path asked for, in the model
        in_space : whether it is one for models in space

        Raises
        ------
        InputError
            If friction has no exact path.
        """
        if not self.law.straight:
            raise InputError(
                f"is \"exact\", but the friction of contact '{self.label}' has no straight branches to follow; "
                'expected increments, a number or "auto"',
                where=where,
            )
        slips = not self.coulomb or self.friction not in (0.0, "stick", "tied")
        if in_space and slips and not self.facets:
            raise InputError(
                f"is \"exact\", but friction on the exact cone of contact '{self.label}' turns between events; "
                'expected facets there, or increments, a number or "auto"',
                where=where,
            )

    def check_change(self, friction: Any, where: Where) -> None:
        """What goes with another coefficient, or two of them, in a step.

        Raises
        ------
        InputError
            If the contact has a law of its own, or no axis for two.
        """
        if not isinstance(self.law, Coulomb):
            raise InputError(
                f"is given, but friction has a law of its own, {self.law.title()}; only coefficients change",
                where=where,
            )
        if isinstance(friction, tuple) and self.friction_axis is None:
            raise InputError(
                "has two coefficients; expected friction_axis in the contact, the direction of the first", where=where
            )

    @classmethod
    def between(cls, one: str, other: str, **options: Any) -> Contact:
        """Two boundaries of which neither is named the nonmortar side: the coarser one is taken, see ``side``.

        Parameters
        ----------
        options : everything else that a contact takes

        Examples
        --------
        >>> Contact.between("shaft", "hub", friction=0.1).side
        'coarser'
        """
        return cls(one, other, **{"side": "coarser", **options})

    @property
    def label(self) -> str:
        """The name in results."""
        return self.name or self.nonmortar

    @property
    def slides(self) -> bool:
        """Whether its pairs follow the bodies."""
        return self.sliding == "finite"

    def meshed_sides(self, mesh: Mesh) -> tuple[str, ...]:
        """The boundaries of a mesh among its sides, the nonmortar one first; an obstacle is none."""
        sides = (self.nonmortar, self.mortar)
        return tuple(side for side in sides if isinstance(side, str) and side in mesh.boundaries)

    @property
    def mean_compliance(self) -> float:
        """Closure per pressure, up to the last point where it has a closure, length per pressure."""
        return self.normal_compliance if self.closure is None else self.closure.mean_compliance

    @property
    def tied(self) -> bool:
        """Whether it neither slips nor opens."""
        return self.friction == "tied"

    @cached_property
    def law(self) -> FrictionLaw:
        """The law of its friction: Coulomb's where ``friction`` is none itself."""
        if isinstance(self.friction, FrictionLaw):
            return self.friction
        return Coulomb(self.friction, self.adhesion, self.shear_limit)

    @property
    def coulomb(self) -> bool:
        """Whether friction has no other bound than ``friction * pressure``."""
        return isinstance(self.law, Coulomb) and self.shear_limit is None and self.adhesion == 0.0

    @property
    def coefficient(self) -> float:
        """Coulomb's coefficient; infinite where it sticks or is tied, NaN where there is no one number."""
        return self.law.coefficient if isinstance(self.law, Coulomb) else math.nan
