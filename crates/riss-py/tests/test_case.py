"""Cases: built in code, read from files, refused with all problems at once."""

import json
from pathlib import Path

import numpy as np
import pytest

import riss

CASES = Path(__file__).parents[3] / "cases"


def strip(**more):
    sections = {
        "material": {"young": 210e3, "poisson": 0.3, "plane": "strain"},
        "geometry": {"rectangle": {"lower": [0, -20], "upper": [20, 20]}},
        "crack": [{"name": "edge", "path": np.array([[0.0, 0.0], [6.0, 0.0]])}],
        "remote_stress": {"yy": 80},
        "rigid_motion": "mean-is-zero",
        "nodes": {"layout": {"graded": {"spacing": 1.0}}},
    }
    return riss.Case(**{**sections, **more})


def test_a_case_from_sections_is_that_of_the_same_file():
    text = """
        rigid_motion = 'mean-is-zero'
        material = { young = 210e3, poisson = 0.3, plane = 'strain' }
        geometry.rectangle = { lower = [0, -20], upper = [20, 20] }
        crack = [{ name = 'edge', path = [[0, 0], [6, 0]] }]
        remote_stress.yy = 80
        nodes.layout.graded.spacing = 1.0
    """
    a, b = strip().run(), riss.Case.parse(text).run()
    assert a.tip()["K_I"] == b.tip()["K_I"]


def test_all_problems_come_at_once_with_place_and_suggestion():
    with pytest.raises(riss.CaseError) as caught:
        riss.Case.parse("[material]\nyoung = -1\npoison = 0.3\n", "bad.toml")
    problems = caught.value.problems
    assert len(problems) >= 2
    misspelt = next(p for p in problems if p["key"] == "material.poison")
    assert "poisson" in misspelt["suggestion"] and misspelt["place"] == "bad.toml:3:1"
    assert isinstance(caught.value, ValueError) and "bad.toml:3:1" in str(caught.value)


def test_what_a_case_cannot_hold_is_refused():
    with pytest.raises(TypeError, match="cannot hold a object"):
        strip(title=object())
    with pytest.raises(riss.CaseError):
        riss.read(CASES / "no-such-case.toml")


def test_overrides_win_over_the_file_and_each_other():
    case = riss.read(CASES / "shear-edge-crack" / "case.toml", set={"nodes.layout.graded.spacing": 1.0})
    coarse = case.run().last
    finer = case.override({"nodes.layout.graded.spacing": 0.5}).run().last
    assert finer.record["nodes"] > coarse.record["nodes"]
    longer = strip().override({"crack": [{"name": 'a "b" ä', "path": np.array([[0, 0], [8, 0]])}]}).run()
    assert longer.tip('a "b" ä')["K_I"] > strip().run().tip()["K_I"]


def test_the_schema_knows_the_sections():
    assert {"material", "crack", "growth"} <= set(riss.schema()["properties"])
    assert json.dumps(riss.schema())
