"""What is told about a mesh when it is opened."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Integers
from workbench.core.facets import facet_table
from workbench.core.mesh import Mesh
from workbench.core.nouns import count_of, plural
from workbench.core.seams import seam_pairs


def report_lines(mesh: Mesh) -> tuple[str, ...]:
    """The report on load, one sentence a line; vertices and simplices are numbered from 0."""
    topology = mesh.topology
    noun = "triangle" if mesh.dimension == 2 else "tetrahedron"
    lines = [
        f"{count_of(mesh.vertex_count, 'vertex')}, {count_of(mesh.simplex_count, noun)}, "
        f"{count_of(topology.component_count, 'component')}."
    ]
    lines.append(_boundary_line(mesh))
    lines.append(_orientation_line(mesh))
    if len(topology.nonmanifold_facets):
        first = ", ".join(map(str, topology.nonmanifold_facets[0]))
        facet = "edge" if mesh.dimension == 2 else "face"
        verb = "is" if len(topology.nonmanifold_facets) == 1 else "are"
        lines.append(
            f"{count_of(len(topology.nonmanifold_facets), facet)} {verb} not manifold "
            f"(more than two {plural(noun)} meet there), the first between vertices {first}."
        )
    if len(topology.nonmanifold_vertices):
        lines.append(_list_line(topology.nonmanifold_vertices, "vertex", "not manifold (several fans touch there)"))
    if len(topology.degenerate):
        without = "no area" if mesh.dimension == 2 else "no volume"
        lines.append(_list_line(topology.degenerate, noun, f"degenerate ({without})"))
    if len(topology.repeated):
        lines.append(_list_line(topology.repeated, noun, "on the same vertices as an earlier one"))
    if len(topology.unreferenced):
        lines.append(_list_line(topology.unreferenced, "vertex", f"in no {noun}"))
    lines.append(_texture_line(mesh))
    return tuple(line for line in lines if line)


def first_few(numbers: Integers, most: int = 3) -> str:
    """`4, 7, 9, ...`: the first of the numbers (k,) of offenders."""
    shown = ", ".join(str(number) for number in numbers[:most])
    return shown + (", ..." if len(numbers) > most else "")


def _list_line(numbers: Integers, noun: str, what: str) -> str:
    verb = "is" if len(numbers) == 1 else "are"
    return f"{count_of(len(numbers), noun)} {verb} {what}: {first_few(numbers)}."


def _boundary_line(mesh: Mesh) -> str:
    topology = mesh.topology
    if mesh.dimension == 3:
        facets, vertices = len(topology.boundary_facets), len(topology.boundary_vertices)
        return f"Boundary of {count_of(facets, 'triangle')} and {count_of(vertices, 'vertex')}."
    loops = topology.boundary_loops
    if not loops:
        boundary = "No boundary (closed)"
    else:
        lengths = ", ".join(str(len(loop)) for loop in loops[:5]) + (", ..." if len(loops) > 5 else "")
        boundary = f"{count_of(len(loops), 'boundary loop')} ({lengths} edges)"
    genus = "" if topology.genus is None else f", genus {topology.genus}"
    shape = ": a disc" if topology.is_disc else ""
    return f"{boundary}, Euler characteristic {topology.euler_characteristic}{genus}{shape}."


def _orientation_line(mesh: Mesh) -> str:
    topology = mesh.topology
    noun = "triangle" if mesh.dimension == 2 else "tetrahedron"
    if mesh.dimension == 3:
        negative = len(topology.negative)
        if not negative:
            return "Consistently oriented, every tetrahedron positively."
        if negative == mesh.simplex_count:
            return "Every tetrahedron is negatively oriented; volumes are taken without their sign."
        turned = _list_line(topology.negative, noun, "negatively oriented")[:-1]
        return f"{turned}; volumes are taken without their sign."
    if not topology.is_orientable:
        return "Not orientable (one-sided)."
    if not topology.is_consistently_oriented:
        return "Not consistently oriented: some neighbouring triangles run against each other."
    if len(topology.negative) == mesh.simplex_count:
        return "Consistently oriented, clockwise."
    if len(topology.negative):
        return f"Consistently oriented; {_list_line(topology.negative, noun, 'folded over (clockwise)')}"
    return "Consistently oriented."


def _texture_line(mesh: Mesh) -> str:
    if mesh.texture is None:
        return ""
    seams = int(np.count_nonzero(seam_pairs(mesh.texture, facet_table(mesh.simplices))))
    if not seams:
        return "Texture coordinates at every corner, without seams."
    return f"Texture coordinates at every corner, with {count_of(seams, 'seam edge')}."
