# SPDX-License-Identifier: BSD-3-Clause
"""Geometries of Gmsh (``.geo``), meshed by Gmsh itself where it is installed."""

from __future__ import annotations

from pathlib import Path

from signorini.errors import InputError

SUFFIX = ".geo"


def mesh_geometry(path: Path, mesh: Path) -> None:
    """Mesh a geometry, in space if it has volumes, and write the mesh.

    Parameters
    ----------
    path : of the ``.geo`` file; sizes, order and physical groups are its own
    mesh : of the ``.msh`` file to be written

    Raises
    ------
    InputError
        If Gmsh is not installed, or cannot read or mesh the geometry.
    """
    try:
        import gmsh
    except (ImportError, OSError) as error:  # the wheel needs libraries of the system
        raise InputError(
            f"'{path}' is a geometry, which Gmsh must mesh, and there is no Gmsh ({error}); expected "
            "pip install 'signorini[gmsh]', or a mesh (gmsh -2 or -3, saved as .msh)",
            where=("mesh", "file"),
        ) from error
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        gmsh.model.mesh.generate(gmsh.model.getDimension())
        gmsh.write(str(mesh))
    except Exception as error:  # Gmsh knows no other
        raise InputError(f"Gmsh cannot mesh '{path}': {error}", where=("mesh", "file")) from error
    finally:
        gmsh.finalize()
