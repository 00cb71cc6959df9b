"""Cohesive cracks in the plane: load curves, states with fields, callbacks, files."""

import json
from pathlib import Path

import numpy as np
import pytest

import riss

CASE = Path(__file__).parents[3] / "cases" / "double-edge-notched-plane" / "case.toml"


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("broken")
    run = riss.read(CASE, {"nodes.layout.graded.tip_spacing": 2}).run(out=folder)
    run.folder = folder
    return run


def test_cohesive_cracks_have_a_load_curve(broken):
    curve = broken.load_curve
    assert broken.peak["load"] == curve["load"].max()
    assert broken.dissipated_energy == curve["dissipated_energy"][-1]
    # G_f times the ligament, less what bonds hold back at a hundredth of the strength or less.
    assert 0.97 * 5.5 < broken.dissipated_energy < 5.5
    assert curve["external_work"][-1] == pytest.approx(
        curve["dissipated_energy"][-1] + curve["elastic_energy"][-1], rel=0.01
    )
    assert broken.end["kind"] == "limit-reached" and "peak" in broken.end["reason"]
    table = broken.to_pandas()
    assert len(table) == len(curve["load"]) and table["step"].dtype.kind == "i"
    assert repr(broken).startswith("<riss.Run of")


def test_states_have_fields(broken):
    numbers = [step.number for step in broken.steps]
    assert broken.peak["step"] in numbers and numbers[-1] == len(broken.load_curve["load"]) - 1
    for step in broken.steps:
        point = {name: column[step.number] for name, column in broken.load_curve.items()}
        assert step.record["load_factor"] == point["load_factor"]
        # The same force through the upper edge as on the curve.
        assert step.record["reactions"]["top"][1] == pytest.approx(point["load"], abs=1e-6 * broken.peak["load"])
        assert step.record["cracks"][0]["name"] == "ligament"


def test_files_are_those_of_the_program(broken):
    record = json.loads((broken.folder / "results.json").read_text())
    assert record["load_curve"] == broken.record["load_curve"] and record["loading"] == broken.record["loading"]
    assert all((broken.folder / name).is_file() for name in record["files"])


def test_states_need_not_be_heard(broken):
    run = riss.read(CASE, {"nodes.layout.graded.tip_spacing": 2}).run(on_step=lambda step: False)
    assert len(run.steps) == 1
    assert np.array_equal(run.load_curve["load"], broken.load_curve["load"])


def test_grown_cracks_are_shown_by_the_states():
    case = riss.read(CASE.parents[1] / "eccentric-notch" / "case.toml")
    run = case.override({"growth.increment": 6, "growth.steps": 2, "loading.largest_displacement": 0.03}).run()
    path = run.path("crack")
    assert len(path) == 4 and path[2, 0] > -60 and path[3, 1] > 45
    assert run.record["growth_end"]["kind"] == "steps-done"


def test_a_picture(broken):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert riss.plot.load_curve(broken).get_lines()[0].get_ydata().max() == broken.peak["load"]
