"""What riss writes for ParaView, read and drawn by VTK itself."""

from pathlib import Path

import numpy as np
import pytest
import pyvista

import riss

from test_case import strip
from test_solid import penny


def read(path: Path) -> pyvista.DataSet:
    """The data of the last step of a collection."""
    reader = pyvista.PVDReader(path)
    reader.set_active_time_value(reader.time_values[-1])
    return reader.read()[0]


def draw(data: pyvista.DataSet, scalars: str, path: Path) -> np.ndarray:
    """A picture, and the part of it that is not background."""
    plotter = pyvista.Plotter(off_screen=True, window_size=(400, 400))
    plotter.add_mesh(data, scalars=scalars, show_scalar_bar=False)
    plotter.view_xy()
    plotter.set_background("white")
    plotter.screenshot(path)
    plotter.close()
    pixels = pyvista.read(path).point_data.active_scalars
    return (pixels[:, :3] != 255).any(axis=1)


def test_a_grown_crack_in_the_plane(tmp_path):
    run = strip(growth={"increment": 1.0, "steps": 2}).run(out=tmp_path)
    body = read(tmp_path / "fields.pvd")
    assert body.n_points == len(run.last.points) and body.n_cells == len(run.last.triangles)
    assert np.allclose(body.point_data["displacement"][:, :2], run.last.displacement, rtol=1e-6, atol=1e-12)
    assert np.allclose(body.point_data["von_mises"], run.last.von_mises, rtol=1e-6)
    # The area of the strip, by VTK's own reckoning.
    assert body.compute_cell_sizes().cell_data["Area"].sum() == pytest.approx(20 * 40, rel=1e-9)
    inked = draw(body, "von_mises", tmp_path / "picture.png")
    assert 0.1 < inked.mean() < 0.9


def test_a_solid_with_a_crack(tmp_path):
    run = penny().run(out=tmp_path)
    nodes = read(tmp_path / "nodes.pvd")
    assert nodes.n_points == run.record["nodes"]
    assert np.allclose(nodes.point_data["displacement"], run.displacement, rtol=1e-6, atol=1e-12)
    boundary = read(tmp_path / "boundary.pvd")
    areas = boundary.compute_cell_sizes().cell_data["Area"]
    lower, upper = np.array(boundary.bounds).reshape(3, 2).T
    a, b, c = upper - lower
    assert areas.sum() == pytest.approx(2 * (a * b + b * c + c * a), rel=1e-6)
    assert np.isfinite(boundary.point_data["von Mises stress"]).all()
    crack = read(tmp_path / "cracks.pvd")
    # A disc of radius 1 in triangles between its nodes.
    assert crack.compute_cell_sizes().cell_data["Area"].sum() == pytest.approx(np.pi, rel=0.02)
    inked = draw(crack, "opening", tmp_path / "crack.png")
    assert 0.1 < inked.mean() < 0.9


def test_hand_over_in_memory(tmp_path):
    step = strip().run().last
    grid = step.to_pyvista()
    assert grid.n_cells == len(step.triangles)
    assert np.array_equal(grid.point_data["von_mises"], step.von_mises)
    grid.save(tmp_path / "again.vtu")
    assert pyvista.read(tmp_path / "again.vtu").n_points == grid.n_points
    run = penny().run()
    assert run.to_pyvista().n_points == run.record["nodes"]
    assert run.crack_to_pyvista("penny").compute_cell_sizes().cell_data["Area"].sum() == pytest.approx(np.pi, rel=0.02)
    assert isinstance(run, riss.SolidRun)
