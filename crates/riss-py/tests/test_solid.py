"""Solids: cases, factors along fronts, fields at nodes."""

from pathlib import Path

import numpy as np
import pytest

import riss

CASES = Path(__file__).parents[3] / "cases"


def penny(**more):
    sections = {
        "rigid_motion": "mean-is-zero",
        "material": {"young": 1000, "poisson": 0.3},
        "geometry": {"box": {"lower": [-6, -6, -6], "upper": [6, 6, 6]}},
        "crack": [{"name": "penny", "disc": {"center": np.zeros(3), "normal": [0, 0, 1], "radius": 1}}],
        "remote_stress": {"zz": 1},
        "nodes": {"spacing": 1.0, "front_spacing": 0.1, "growth": 0.2},
    }
    return riss.SolidCase(**{**sections, **more})


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("penny")
    run = penny().run(out=folder)
    run.folder = folder
    return run


def test_k_along_the_front_is_that_of_the_closed_form(run):
    # Sneddon 1946: 2 sigma sqrt(a/pi) in an infinite body; the box is six times as wide as the crack.
    front = run.front()
    assert front["position"].shape == (len(front["s"]), 3)
    assert np.nanmax(np.abs(front["K_I"] / (2 / np.sqrt(np.pi)) - 1)) < 0.01
    table = run.to_pandas()
    assert len(table) == len(front["s"]) and set(table["crack"]) == {"penny"}


def test_fields_are_those_of_the_nodes(run):
    n = run.record["nodes"]
    assert run.nodes.shape == run.displacement.shape == (n, 3)
    assert run.stress.shape == (n, 3, 3)
    assert np.allclose(run.stress, run.stress.transpose(0, 2, 1))
    top = run.nodes[:, 2] == 6
    # Far above the crack the stress is the remote one; the crack takes about a percent away.
    assert np.abs(run.stress[top, 2, 2] - 1).max() < 0.02
    points, opening = run.opening("penny")
    # An ellipsoid: 8 (1 - nu^2) sigma sqrt(a^2 - r^2) / (pi E); nodes of this spacing scatter by 2.5 %.
    inner = np.hypot(points[:, 0], points[:, 1]) < 0.9
    exact = 8 * 0.91 / (np.pi * 1000) * np.sqrt(1 - np.hypot(*points[inner, :2].T) ** 2)
    assert np.mean(opening[inner, 2] / exact) == pytest.approx(1, abs=0.01)
    assert np.abs(opening[inner, 2] / exact - 1).max() < 0.04
    with pytest.raises(KeyError, match="cracks are penny"):
        run.opening("pony")


def test_files_are_those_of_the_program(run):
    names = {path.name for path in run.folder.iterdir()}
    assert {"results.json", "report.html", "nodes.pvd", "cracks.pvd"} <= names


def test_a_file_says_by_its_method_what_it_is():
    assert isinstance(riss.read(CASES / "penny-shaped-crack" / "case.toml"), riss.SolidCase)
    assert isinstance(riss.read(CASES / "shear-edge-crack" / "case.toml"), riss.Case)
    with pytest.raises(riss.CaseError, match="riss.Case reads it"):
        riss.SolidCase.read(CASES / "shear-edge-crack" / "case.toml")
    assert "elliptical" in str(riss.schema("collocation")) or "ellipse" in str(riss.schema("collocation"))


def test_problems_come_with_place_and_suggestion():
    with pytest.raises(riss.CaseError) as caught:
        penny(material={"young": -1, "poisson": 0.3}, remote_stres={"zz": 1})
    problems = {p["key"]: p for p in caught.value.problems}
    assert problems["remote_stres"]["suggestion"] == "did you mean `remote_stress`?"
    assert problems["material.young"]["value"] == "-1"
