"""Growth: callbacks that stop or change a run, states to go on from, Ctrl-C."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import riss

from test_case import strip

GROWTH = {"increment": 1.0, "steps": 4}


@pytest.fixture(scope="module")
def run():
    return strip(growth=GROWTH).run()


def test_steps_come_in_order_and_the_end_has_a_reason(run):
    assert [s.number for s in run.steps] == [0, 1, 2, 3, 4]
    assert run.end["kind"] == "steps-done" and run.end["reason"]
    a = run.history("edge")["a"]
    assert a == pytest.approx([6, 7, 8, 9, 10], abs=1e-3)
    assert (np.diff(run.history("edge")["K_I"]) > 0).all()
    assert run.path("edge")[-1] == pytest.approx([10, 0], abs=0.02)


def test_a_callback_sees_each_step_and_may_stop():
    seen = []

    def on_step(step):
        seen.append(step.number)
        return step.number < 2

    assert len(strip(growth=GROWTH).run(on_step=on_step).steps) == 3
    assert seen == [0, 1, 2]


def test_an_error_in_a_callback_ends_the_run_and_comes_through():
    def on_step(step):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        strip(growth=GROWTH).run(on_step=on_step)


def test_a_run_goes_on_from_a_state_to_the_same_bits(run):
    rest = strip(growth=GROWTH).run(start=run.steps[2].state)
    assert [s.number for s in rest.steps] == [2, 3, 4]
    assert rest.tip()["K_I"] == run.tip()["K_I"]


def test_another_case_takes_over_from_the_next_step(run):
    other = strip(growth=GROWTH, remote_stress={"yy": 40})
    changed = strip(growth=GROWTH).run(on_step=lambda step: other if step.number == 1 else None)
    assert [s.number for s in changed.steps] == [0, 1, 2, 3, 4]
    k, half = run.history()["K_I"], changed.history()["K_I"]
    assert half[:2] == pytest.approx(k[:2], rel=1e-12)
    assert half[2:] == pytest.approx(0.5 * k[2:], rel=1e-6)


def test_written_runs_can_be_read_again(tmp_path, run):
    case = strip(growth=GROWTH)
    case.run(out=tmp_path, on_step=lambda step: step.number < 2)
    state = riss.State.read(tmp_path, 2)
    rest = case.run(start=state, out=tmp_path)
    assert rest.tip()["K_I"] == run.tip()["K_I"]


def test_the_interpreter_is_free_while_rust_works():
    ticks = []
    stop = threading.Event()

    def tick():
        while not stop.wait(0.005):
            ticks.append(time.perf_counter())

    thread = threading.Thread(target=tick)
    thread.start()
    try:
        strip(nodes={"layout": {"graded": {"spacing": 0.5}}}).run()
    finally:
        stop.set()
        thread.join()
    assert len(ticks) > 5


def test_what_cannot_be_solved_is_an_analysis_error():
    with pytest.raises(riss.AnalysisError, match="factored|neighbors"):
        strip(nodes={"layout": {"structured": {"nx": 11, "ny": 21}}}, approximation={"dilation": 1.01}).run()


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of Unix")
def test_ctrl_c_ends_the_run_after_the_step_at_hand(tmp_path):
    program = f"""
import signal, sys
# Who is started in the background ignores the signal.
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {os.path.dirname(__file__)!r})
from test_case import strip
print("begin", flush=True)
strip(growth={{"increment": 0.05, "steps": 200}}).run(out={str(tmp_path)!r})
"""
    process = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "begin\n"
    while not (tmp_path / "results.json").exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert "KeyboardInterrupt" in errors and process.returncode != 0
    state = riss.State.read(tmp_path, 0)
    assert state.step == 0
