"""Results: tips, arrays and shapes, fields at any points, tables."""

import math
import pickle

import numpy as np
import pytest

import riss

from test_case import CASES, strip


@pytest.fixture(scope="module")
def run():
    return strip().run()


def test_the_factor_is_that_of_the_handbook(run):
    tip = run.tip("edge", "end")
    # Edge crack in a strip, Tada, Paris and Irwin: within 0.5 % for every ratio.
    r = 6 / 20
    f = math.sqrt(2 / (math.pi * r) * math.tan(math.pi * r / 2)) / math.cos(math.pi * r / 2)
    f *= 0.752 + 2.02 * r + 0.37 * (1 - math.sin(math.pi * r / 2)) ** 3
    assert tip["K_I"] == pytest.approx(80 * math.sqrt(math.pi * 6) * f, rel=0.01)
    assert abs(tip["K_II"]) < 1e-3 * tip["K_I"]
    assert run.tip(0) == run.tip() == tip
    with pytest.raises(KeyError, match="no tip of crack 'other'"):
        run.tip("other")


def test_arrays_have_their_shapes(run):
    step = run.last
    n, m = len(step.points), step.record["nodes"]
    assert step.displacement.shape == (n, 2) and step.stress.shape == step.strain.shape == (n, 2, 2)
    for values in (step.von_mises, step.error_indicator, step.out_of_plane_stress, step.out_of_plane_strain):
        assert values.shape == (n,) and np.isfinite(values).all()
    assert step.triangles.shape[1] == 3 and step.triangles.max() == n - 1
    assert step.nodes.shape == step.nodal_parameters.shape == (m, 2) and step.support_radii.shape == (m,)
    # Plane strain.
    assert np.allclose(step.out_of_plane_stress, 0.3 * (step.stress[:, 0, 0] + step.stress[:, 1, 1]))


def test_triangles_cover_the_body_counterclockwise(run):
    a, b, c = (run.last.points[run.last.triangles[:, k]] for k in range(3))
    areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert (areas > 0).all() and areas.sum() == pytest.approx(20 * 40)


def test_fields_at_points_are_those_of_the_step(run):
    step = run.last
    # Points off the crack see by themselves where they are.
    off = np.abs(step.points[:, 1]) > 1e-9
    points = step.points[off]
    assert np.allclose(step.displacement_at(points), step.displacement[off], rtol=0, atol=1e-9 * 80 / 210e3 * 20)
    assert np.allclose(step.stress_at(points), step.stress[off], rtol=0, atol=1e-4)
    assert np.isnan(step.stress_at([[50.0, 0.0]])).all()
    above, below = step.displacement_at([[3.0, 0.0], [3.0, 0.0]], sights=[[3.0, 1e-6], [3.0, -1e-6]])
    points, opening = step.opening("edge")
    at = np.interp(3.0, points[:, 0], opening[:, 1])
    assert above[1] - below[1] == pytest.approx(at, rel=0.02) and at > 0
    with pytest.raises(ValueError, match="shape"):
        step.stress_at([[1.0, 2.0, 3.0]])


def test_the_gradient_is_the_derivative_of_the_displacement(run):
    at, h = np.array([11.0, 3.0]), 1e-6
    steps = h * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    u = run.last.displacement_at(at + steps)
    expected = np.column_stack([u[0] - u[1], u[2] - u[3]]) / (2 * h)
    assert np.allclose(run.last.displacement_gradient_at(at)[0], expected, rtol=1e-5, atol=1e-12)


def test_shape_functions_reproduce_linear_fields(run):
    neighbors, values, gradients = run.last.shape_functions(7.0, 2.0)
    nodes = run.last.nodes[neighbors]
    assert values.sum() == pytest.approx(1)
    assert values @ nodes == pytest.approx([7.0, 2.0])
    assert gradients.T @ nodes == pytest.approx(np.eye(2), abs=1e-9)
    with pytest.raises(ValueError, match="not in the body"):
        run.last.shape_functions(-1.0, 0.0)


def test_a_point_shows_the_stress_of_a_uniform_field():
    square = {"rectangle": {"lower": [0, 0], "upper": [1, 1]}}
    case = strip(
        geometry=square, crack=[], remote_stress={"xx": 2, "xy": 1}, nodes={"layout": {"graded": {"spacing": 0.2}}}
    )
    step = case.run().last
    assert np.allclose(step.stress_at(np.random.default_rng(1).random((50, 2))), [[2, 1], [1, 0]], atol=1e-8)


def test_tables_have_the_columns_of_the_file(tmp_path, run):
    strip().run(out=tmp_path)
    header = (tmp_path / "history.csv").read_text().splitlines()[0].split(",")
    table = run.to_pandas()
    assert list(table.columns) == header and table["K_I"][0] == run.tip()["K_I"]
    assert (tmp_path / "results.json").exists() and (tmp_path / "report.html").exists()


def test_meshio_gets_all_fields(run):
    mesh = run.last.to_meshio()
    assert len(mesh.points) == len(run.last.points)
    assert {"displacement", "stress", "strain", "von_mises", "error_indicator"} == set(mesh.point_data)


def test_pictures(run):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ax = riss.plot.field(run.last, "stress_yy")
    riss.plot.paths(run, ax=ax)
    riss.plot.history(run)
    with pytest.raises(ValueError, match="there is no field"):
        riss.plot.field(run.last, "stress_zz")


def test_states_can_be_pickled():
    case = strip(growth={"increment": 1.0, "steps": 1})
    state = case.run().last.state
    assert pickle.loads(pickle.dumps(state)).step == state.step == 1


def test_a_gallery_case():
    run = riss.read(CASES / "shear-edge-crack" / "case.toml").run()
    # Converged finite elements, as in the case's expected.json.
    assert run.tip()["K_I"] == pytest.approx(34.04, rel=0.005)
