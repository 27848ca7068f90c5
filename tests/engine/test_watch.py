"""What is watched comes with every map: values as the command line has them, at rest and while the solver runs."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import build_elements, determinants, signed_singular_values
from workbench.core.measure import DESCRIPTORS, Measure, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.registry import registry
from workbench.engine.live import LiveColours


def folded(square: Mesh) -> np.ndarray:
    """A map of the square with some inverted triangles."""
    x, y = square.vertices.T
    return np.column_stack([x * (1.0 + 0.3 * y), np.where(x > 0.7, y - 1.8 * (x - 0.7) * (y > 0.4), y)])


@pytest.mark.parametrize("name", ["square", "cube"])
def test_every_distortion_is_watched_with_the_values_of_its_own(name: str, request: pytest.FixtureRequest) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    positions = folded(mesh) if name == "square" else mesh.vertices @ np.diag([1.2, 0.7, 1.1])
    elements = build_elements(mesh)
    sigma = signed_singular_values(elements, positions)
    colours = LiveColours(elements)
    ids = sorted(registry().distortions)
    assert colours.watch(tuple(Measure(id) for id in ids), False) == []
    fields = colours.of(positions, inverted=0, moving=False).fields
    assert sorted(fields) == ids
    for id in ids:
        expected = np.minimum(registry().distortions[id].value(sigma), np.finfo(np.float32).max)
        np.testing.assert_allclose(fields[id], expected, rtol=2e-6, atol=1e-30, err_msg=id)


def test_descriptors_keep_the_sign_of_inverted_simplices(square: Mesh) -> None:
    elements, positions = build_elements(square), folded(square)
    sigma = SingularValues(signed_singular_values(elements, positions))
    det = determinants(elements, positions)
    assert (det < 0).any() and (det > 0).any()
    values = {id: Measure(id).prepare(2)(sigma) for id in DESCRIPTORS}
    np.testing.assert_allclose(values["det"], det, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(values["sigma1"] * values["sigman"], det, rtol=1e-12, atol=1e-14)
    np.testing.assert_array_equal(sigma.inverted, det <= 0)


def test_formulas_with_parameters_are_measures_of_their_own(square: Mesh) -> None:
    half, double = (Measure.of("t*sum(sigma^2)", {"t": t}) for t in (0.5, 2.0))
    assert half.id != double.id and Measure.of("t*sum(sigma^2)", {"t": 0.5}) == half
    sigma = SingularValues(signed_singular_values(build_elements(square), folded(square)))
    np.testing.assert_allclose(4.0 * half.prepare(2)(sigma), double.prepare(2)(sigma))
    np.testing.assert_allclose(half.prepare(2)(sigma), 0.5 * Distortion.resolve("dirichlet").value(sigma.signed))
    with pytest.raises(WorkbenchError, match="nonsense"):
        Measure("nonsense + sigma1").prepare(2)


def test_what_cannot_be_made_is_said_and_the_rest_is_made(square: Mesh) -> None:
    colours = LiveColours(build_elements(square))
    sentences = colours.watch((Measure("det"), Measure("sigma3"), Measure("sigma1 +")), False)
    assert len(sentences) == 2 and "sigma3" in sentences[0]
    made = colours.of(square.vertices, inverted=0, moving=False)
    assert list(made.fields) == ["det"] and made.singular_values is None


def test_singular_values_come_only_where_they_are_watched(square: Mesh) -> None:
    elements = build_elements(square)
    colours = LiveColours(elements)
    colours.watch((), True)
    made = colours.of(folded(square), inverted=0, moving=False)
    assert made.singular_values.dtype == np.float32 and not made.fields
    np.testing.assert_allclose(made.singular_values, signed_singular_values(elements, folded(square)), rtol=1e-6)
    colours.watch((Measure("det"),), False)
    assert colours.of(folded(square), inverted=0, moving=True).singular_values is None
