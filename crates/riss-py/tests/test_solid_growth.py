"""Growing and cohesive cracks of solids: steps, callbacks, states, load curves."""

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import riss

CASES = Path(__file__).parents[3] / "cases"


def bar(**more):
    """A bar with an edge crack over its whole width, coarse."""
    sections = {
        "rigid_motion": "mean-is-zero",
        "material": {"young": 1000, "poisson": 0.2},
        "geometry": {"box": {"lower": [0, 0, -2], "upper": [4, 1, 2]}},
        "crack": [{"name": "edge", "polygon": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}],
        "remote_stress": {"zz": 1},
        "nodes": {"spacing": 0.5, "front_spacing": 0.25},
        "fracture": {"points": 3},
        "growth": {
            "steps": 2,
            "increment": 0.4,
            "criterion": {"largest-principal-stress": {"tensile_strength": 0.5}},
        },
    }
    return riss.SolidCase(**{**sections, **more})


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bar")
    run = bar().run(out=folder)
    run.folder = folder
    return run


def test_cracks_grow_step_by_step(run):
    assert [s.number for s in run.steps] == [0, 1, 2]
    assert run.end["kind"] == "steps-done" and run.end["reason"]
    history = run.history()
    assert (np.diff(history["crack_area"]) > 0).all() and (np.diff(history["K_I_max"]) > 0).all()
    assert history["crack_area"][0] == pytest.approx(1, rel=1e-6)
    # The front goes straight on by the increment, over the whole width.
    assert history["crack_area"][1] == pytest.approx(1.4, rel=0.02)
    assert run.fronts == run.last.fronts and run.record["steps"][2]["fronts"] == run.fronts
    table = run.to_pandas()
    assert set(table["step"]) == {0, 1, 2} and set(table["crack"]) == {"edge"}


def test_surfaces_are_triangles_with_the_area_of_the_crack(run):
    for step in run.steps:
        vertices, triangles = step.surface("edge")
        assert vertices.shape[1] == triangles.shape[1] == 3
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        assert area == pytest.approx(step.areas["edge"], rel=1e-6)
    with pytest.raises(KeyError, match="cracks are edge"):
        run.surface("middle")


def test_a_callback_sees_each_step_and_may_stop():
    seen = []

    def on_step(step):
        seen.append((step.number, step.front()["K_I"].max()))
        return step.number < 1

    stopped = bar().run(on_step=on_step)
    assert len(stopped.steps) == 2 and [n for n, _ in seen] == [0, 1]
    assert stopped.end is None and stopped.record["status"] == "stopped"


def test_growth_goes_on_from_a_state_to_the_same_bits(run):
    state = pickle.loads(pickle.dumps(run.steps[1].state))
    rest = bar().run(start=state)
    assert [s.number for s in rest.steps] == [1, 2]
    assert rest.front()["K_I"].tolist() == run.front()["K_I"].tolist()
    again = bar().run(start=riss.State.read(run.folder, 2), out=run.folder)
    assert again.front()["K_I"].tolist() == run.front()["K_I"].tolist()
    assert [s["step"] for s in again.record["steps"]] == [0, 1, 2]


def test_another_case_takes_over_from_the_next_step(run):
    other = bar(remote_stress={"zz": 2})
    changed = bar().run(on_step=lambda step: other if step.number == 0 else None)
    assert [s.number for s in changed.steps] == [0, 1, 2]
    assert [s["step"] for s in changed.record["steps"]] == [0, 1, 2]
    assert changed.steps[1].front()["K_I"] == pytest.approx(2 * run.steps[1].front()["K_I"], rel=1e-6)


def test_states_of_other_cases_are_refused(run):
    with pytest.raises(ValueError, match="state of a solid"):
        riss.read(CASES / "edge-crack-growth-tension" / "case.toml").run(start=run.steps[1].state)
    with pytest.raises(ValueError, match="no other case can take over"):
        riss.read(CASES / "cohesive-bar" / "case.toml").run(on_step=lambda step: bar())


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("broken")
    run = riss.read(CASES / "cohesive-bar" / "case.toml").run(out=folder)
    run.folder = folder
    return run


def test_cohesive_cracks_have_a_load_curve(broken):
    curve = broken.load_curve
    # The strength over the cross section.
    assert broken.peak["load"] == curve["load"].max() == pytest.approx(300, rel=0.01)
    # Softening t = s exp(-s w / G) to a share r of the strength, less what bonds give back: G A (1 - r + r ln(r) / 2).
    r = curve["load"][-1] / curve["load"].max()
    assert broken.dissipated_energy == curve["dissipated_energy"][-1]
    assert broken.dissipated_energy == pytest.approx(10 * (1 - r + 0.5 * r * np.log(r)), rel=1e-3)
    assert curve["external_work"][-1] == pytest.approx(
        curve["dissipated_energy"][-1] + curve["elastic_energy"][-1], rel=0.02
    )
    assert broken.end["kind"] == "limit-reached" and "peak" in broken.end["reason"]
    table = broken.to_pandas()
    assert len(table) == len(curve["load"]) and table["step"].dtype.kind == "i"
    assert (broken.folder / "load_curve.csv").is_file()


def test_states_under_load_have_fields(broken):
    assert broken.shown.point["load"] == broken.peak["load"] and broken.shown.number == broken.peak["step"]
    assert len(broken.steps) > 2
    for step in (broken.shown, broken.last):
        # Between the loads of a bar: the same force everywhere, passed on by the bonds.
        traction = step.traction("plane")
        assert np.mean(traction) == pytest.approx(step.point["load"] / 100, rel=0.05)
        assert step.stress[:, 2, 2].mean() == pytest.approx(step.point["load"] / 100, rel=0.05)
    points, opening = broken.last.opening("plane")
    assert np.ptp(points[:, 2]) < 1e-9 and (opening[:, 2] > 0).all()


def test_states_under_load_need_not_be_heard():
    run = riss.read(CASES / "cohesive-bar" / "case.toml").run(on_step=lambda step: False)
    assert len(run.steps) == 1 and len(run.load_curve["load"]) > 10


def test_pictures_and_other_programs(run, broken, tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    lines = riss.plot.front(run.steps[1]).get_lines()
    assert [line.get_label() for line in lines] == ["K_I", "K_II", "K_III"]
    assert lines[0].get_ydata().tolist() == run.steps[1].front()["K_I"].tolist()
    assert riss.plot.load_curve(broken).get_lines()[0].get_ydata().max() == broken.peak["load"]
    assert len(riss.plot.surface(run).collections) == 1
    with pytest.raises(ValueError, match="no crack is cohesive"):
        riss.plot.load_curve(run)
    surface = pytest.importorskip("pyvista") and run.surface_to_pyvista("edge")
    assert surface.area == pytest.approx(run.last.areas["edge"], rel=1e-6)
    meshio = pytest.importorskip("meshio")
    run.to_meshio().write(tmp_path / "nodes.vtu")
    assert np.allclose(meshio.read(tmp_path / "nodes.vtu").point_data["displacement"], run.displacement)


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of Unix")
def test_ctrl_c_ends_growth_after_the_step_at_hand(tmp_path):
    program = f"""
import signal, sys
# Who is started in the background ignores the signal.
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {os.path.dirname(__file__)!r})
from test_solid_growth import bar
print("begin", flush=True)
growth = {{"steps": 200, "increment": 0.25, "criterion": {{"stress-intensity-factors": {{"exponent": 1}}}}}}
bar(growth=growth).run(out={str(tmp_path)!r})
"""
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "begin\n"
    while not (tmp_path / "results.json").exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert "KeyboardInterrupt" in errors and process.returncode != 0
    assert riss.State.read(tmp_path, 0).step == 0
