"""The Python package over the shared library. Tests assert results, never time."""

import base64
import copy
import gc
import json
import math
import os
import pickle
import signal
import threading
import time
import traceback
import weakref

import numpy as np
import pytest

import impactlab
from impactlab import Environment, Error, Loop, Scenario

FIRST = "corrected/first-impact"


def test_runs_are_arrays_with_units():
    run = Scenario(FIRST).run()
    force, time = run["force"], run.time
    assert len(force) == len(time) > 1000 and time[-1] == 1.0
    assert np.all(np.diff(time) >= 0)
    assert 0.99 * run.peak_force_N < force.max() <= run.peak_force_N
    assert run.unit("force") == "N" and run.unit("first_contact_s") == "s"
    assert run.angles.shape == (len(time), 2)
    # the hub of the two-link arm is its first angle
    assert np.array_equal(run.angles[:, 0], run["hub_angle"])
    with pytest.raises(ValueError):
        force[0] = 1
    assert [e.kind for e in run.events][:2] == ["impact", "contact"]
    assert json.loads(run.json)["peak_force_N"] == pytest.approx(run.peak_force_N, abs=1e-12)


def test_arrays_outlive_their_run():
    force = Scenario(FIRST).run()["force"]
    before = force.sum()
    for _ in range(20):
        Scenario(FIRST).run()
    assert force.sum() == before


def test_parameters_are_documented_attributes():
    scenario = Scenario(FIRST)
    scenario.motor.voltage = 2
    assert scenario["motor.voltage"] == 2.0
    scenario["wall.kind"] = "plane"
    assert scenario.wall.kind == "plane"
    assert "[V]" in type(scenario.motor).voltage.__doc__
    assert set(impactlab.PARAMETERS) >= {"arm.k2", "wall.angle", "run.duration"}
    with pytest.raises(Error, match="motor.voltage"):
        scenario["motor.voltag"] = 1
    with pytest.raises(AttributeError, match="voltage"):
        scenario.motor.voltag = 1
    with pytest.raises(Error) as raised:
        scenario["motor.voltage"] = math.nan
    assert raised.value.parameter == "motor.voltage" and scenario.motor.voltage == 2.0
    assert Scenario(**{"motor__voltage": 3}).motor.voltage == 3.0


def test_what_is_not_there_is_an_error():
    with pytest.raises(Error, match="first-impact"):
        Scenario("corrected/frist-impact")
    with pytest.raises(Error):
        Scenario.from_yaml("title: [")
    with pytest.raises(AttributeError):
        Scenario(FIRST).run(rows=False).peek_force_N


def law(reading):
    return 1 + 0.3 * (0.1 - reading.encoder) + 0.1 * (1 - reading.force)


def test_a_function_and_a_loop_are_the_same_controller():
    scenario = Scenario(FIRST)
    called = scenario.run(controller=law)
    loop = Loop(scenario, command=True, rows=True)
    while not loop.ended:
        loop.command(law(loop.read_sensors()))
        loop.step()
    looped = loop.run()
    assert called.peak_force_N == looped.peak_force_N
    # a stop of the loop between two rows of the grid adds none
    assert np.array_equal(called["force"][-100:], looped["force"][-100:])
    named = scenario.run(controller=lambda r: {"command": law(r), "calculated_force": r.force})
    assert named.peak_force_N == called.peak_force_N
    assert np.nanmax(named["calculated_force"]) > 0


def test_what_a_controller_raises_comes_out():
    with pytest.raises(ZeroDivisionError):
        Scenario(FIRST).run(controller=lambda reading: 1 / 0)


def test_what_a_controller_raises_has_its_place():
    def divide(reading):
        return 1 / (0.1 - reading.time)

    def silent(reading):
        return 1.0 if reading.time < 0.5 else math.nan
    with pytest.raises(ZeroDivisionError) as raised:
        Scenario(FIRST).run(controller=divide)
    assert "divide" in [frame.name for frame in traceback.extract_tb(raised.value.__traceback__)]
    with pytest.raises(Error, match="at t = 0.5 s the controller 'python' did not answer"):
        Scenario(FIRST).run(controller=silent)


def endless():
    """A scenario that would take hours."""
    scenario = Scenario(FIRST)
    scenario.set({"arm.links": 24, "arm.damping_ratio": 0, "run.duration": 90000,
                  "method.step": 0.1, "control.rate": 10})
    return scenario


def steps(scenario):
    loop = Loop(scenario, command=True)
    while not loop.ended:
        loop.command(1.0)
        loop.step()


def waits(reading):
    time.sleep(1000)


WORKS = {
    "run": lambda s: s.run(),
    "run without rows": lambda s: s.run(rows=False),
    "controller": lambda s: s.run(rows=False, controller=lambda reading: 1.0),
    "controller that waits": lambda s: s.run(controller=waits),
    "batch": lambda s: s.batch({"motor.voltage": [1, 2, 3, 4]}),
    "batch of one thread": lambda s: s.batch({"motor.voltage": [1, 2, 3, 4]}, jobs=1),
    "batch of short runs": lambda s: Scenario(FIRST).batch(
        {"motor.voltage": np.linspace(1, 2, 2000000)}),
    "loop": lambda s: Loop(s).step_until(90000),
    "steps": steps,
}


@pytest.mark.parametrize("delay", [0, 0.02, 0.3])
@pytest.mark.parametrize("work", WORKS)
def test_an_interrupt_comes_out(work, delay):
    # the work ends by nothing else, wherever it is then
    scenario = endless()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT))
    try:
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            WORKS[work](scenario)
    finally:
        timer.join()
        signal.signal(signal.SIGINT, before)
    scenario.run.duration = 0.05
    assert scenario.run().status == "ok"


def test_an_interrupted_loop_goes_on():
    scenario = endless()
    loop, other = Loop(scenario), Loop(scenario)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    try:
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            loop.step_until(90000)
    finally:
        timer.join()
        signal.signal(signal.SIGINT, before)
    until = loop.time + 0.01
    loop.step_until(until)
    other.step_until(until)
    assert loop.time == until and np.array_equal(loop.state, other.state)


def test_states_are_bytes():
    loop = Loop(Scenario("compare/hybrid"))
    loop.step_until(0.3)
    assert loop.signals["force"] == loop["force"] and repr(loop).startswith("<Loop at ")
    state = loop.save_state()
    assert isinstance(state, bytes)
    loop.step_until(0.4)
    force, angles = loop["force"], loop.state
    other = Loop(Scenario("compare/hybrid"))
    other.restore_state(state)
    assert other.time == pytest.approx(0.3)
    other.step_until(0.4)
    assert other["force"] == force and np.array_equal(other.state, angles)
    with pytest.raises(Error):
        Loop(Scenario(FIRST)).restore_state(state)


def test_inputs_are_numbers_or_texts():
    loop = Loop(Scenario(FIRST))
    loop.set_input("motor.voltage", 2)
    doubled = loop["motor_torque"]
    loop.set_input("motor.voltage", "1 V")
    assert loop["motor_torque"] == pytest.approx(doubled / 2)
    with pytest.raises(Error, match="motor.voltage"):
        loop.set_input("motor.voltage", "much")


def test_batches_are_runs():
    scenario = Scenario(FIRST)
    volts = np.linspace(1, 3, 101)
    batch = scenario.batch({"motor.voltage": volts, "arm.damping_ratio": [0.0]})
    assert len(batch) == 101 and set(batch.status) == {"ok"}
    scenario.motor.voltage = volts[40]
    scenario["arm.damping_ratio"] = 0.0
    assert scenario.run(rows=False).peak_force_N == batch["peak_force_N"][40]
    with pytest.raises(Error, match="run 1:"):
        scenario.batch({"motor.voltage": [1, math.inf]})


def test_modes_and_predictions():
    scenario = Scenario(FIRST)
    free, shapes = scenario.modes()
    locked, _ = scenario.modes(hub="locked")
    assert abs(free[0]) < 1e-3 < locked[0] and shapes.shape == (2, 2)
    run = scenario.run()
    said = {p.method: p for p in run.predictions}
    assert said["linearised"].peak_N == pytest.approx(run.first_pulse_peak_N, rel=0.05)


def test_scripts_and_files():
    scenario = Scenario(FIRST).change_at(0.2, "motor.voltage", 2.0).push_at(0.5, 1e-3)
    again = Scenario.from_yaml(scenario.yaml)
    assert again.run(rows=False).peak_force_N == scenario.run(rows=False).peak_force_N
    assert FIRST in impactlab.scenarios()


def test_environment_has_the_shape_of_gymnasium():
    environment = Environment(reward=lambda loop, volts: -abs(loop["force"] - 1))
    first, info = environment.reset(seed=3)
    assert first.shape == environment.observation_space.shape and info["time"] == 0
    steps, truncated = 0, False
    while not truncated:
        observation, reward, terminated, truncated, info = environment.step(np.array([1.2]))
        assert reward <= 0 and not terminated
        steps += 1
    assert steps == 200 and environment.run().peak_force_N > 0
    again, _ = environment.reset(seed=3)
    assert np.array_equal(first, again)
    assert environment.action_space.contains(environment.action_space.sample())


def test_figures_show_themselves():
    if impactlab.program() is None:
        pytest.skip("the program is not there")
    run = Scenario(FIRST).run()
    shown = run._repr_html_()
    before, data = shown.split("base64,")
    assert before == '<img src="data:image/svg+xml;'
    image, said = data.split('" alt="')
    assert "<svg" in base64.b64decode(image).decode()[:500] and "peak force 1.33" in said
    assert run.png(100)[:8] == b"\x89PNG\r\n\x1a\n" and len(run.png(300)) > len(run.png(100))
    with pytest.raises(RuntimeError, match="dpi"):
        run.png(5)
    with pytest.raises(RuntimeError, match="rows"):
        Scenario(FIRST).run(rows=False).svg()
    with pytest.raises(RuntimeError, match="loop"):
        Loop(Scenario(FIRST)).run().svg()


def test_a_law_is_drawn_as_it_ran():
    if impactlab.program() is None:
        pytest.skip("the program is not there")
    scenario = Scenario("compare/hybrid").push_at(0.4, 1e-3)
    run = scenario.run(controller=lambda read: {
        "command": 1 + 0.1 * (1 - read.force), "desired_angle": read.encoder / 3,
        "calculated_force": math.nan if read.time < 0.1 else read.force})
    for one in (run, pickle.loads(pickle.dumps(run))):
        assert one._drawn("csv").decode() == run.csv
        assert "Hybrid" in one.svg() and "with control.law" not in one.svg()


def test_frames():
    pytest.importorskip("pandas")
    run = Scenario(FIRST).run()
    frame = run.to_dataframe()
    assert frame.attrs["units"]["force"] == "N" and frame["force"].max() > 1
    assert len(frame) == len(run.time) and not frame.index.is_unique

    # on a grid an instant is there once, and has what the run has there last
    grid = run.to_dataframe(every=2e-3, events=True)
    assert np.array_equal(grid.index, 2e-3 * np.arange(501))
    last = frame["force"][~frame.index.duplicated(keep="last")]
    there = [time for time in last.index if time in grid.index]
    assert len(there) > 400 and np.array_equal(grid["force"][there], last[there])
    told = [word for words in grid["event"] for word in words.split("+") if word]
    assert told == [event.kind for event in run.events]
    first = grid.index[grid["event"] != ""][0]
    assert first - 2e-3 < run.first_contact_s <= first
    for wrong in (0, -1, math.nan):
        with pytest.raises(Error, match="more than 0"):
            run.to_dataframe(every=wrong)
    empty = Scenario(FIRST).run(rows=False).to_dataframe(every=0.1, events=True)
    assert len(empty) == 0


def test_datasets_have_units():
    pytest.importorskip("xarray")
    data = Scenario(FIRST).run().to_xarray(every=1e-3)
    assert data.sizes["time"] == 1001 and data.force.attrs["units"] == "N"
    assert data.time.attrs["units"] == "s" and data.attrs["status"] == "ok"
    assert "force_reading" not in data and float(data.force.max()) > 1


def test_code_is_not_run_unasked(tmp_path):
    mark = tmp_path / "started"
    scenario = Scenario(FIRST).set({"control.law": "process", "control.command": f"touch {mark}"})
    with pytest.raises(Error, match="allow"):
        scenario.run()
    assert not mark.exists()


# --- objects that own handles -----------------------------------------------------------------

COPIES = {"copy": copy.copy, "deepcopy": copy.deepcopy,
          "pickle": lambda one: pickle.loads(pickle.dumps(one)), "method": lambda one: one.copy()}


class Named(Scenario):
    """A kind of one's own."""


@pytest.mark.parametrize("way", COPIES)
def test_scenarios_are_copied_and_pickled(way):
    scenario = Named(FIRST).change_at(0.2, "motor.voltage", 2.0).push_at(0.5, 1e-3)
    scenario["control.settings"] = "a=1 b='ü'"
    other = COPIES[way](scenario)
    assert type(other) is Named and other.name == FIRST and other.yaml == scenario.yaml
    # each is its own, and both are the same run
    other.motor.voltage = 3
    assert scenario.motor.voltage == 1
    other.motor.voltage = 1
    mine, its = json.loads(scenario.run().json), json.loads(other.run().json)
    # expectations are of the file as it stands, and not in a pickle
    for key in ("wall_time_s", "cpu_time_s", "expectations"):
        assert mine.pop(key) and (its.pop(key, None) or way == "pickle")
    assert mine == its
    del scenario
    gc.collect()
    assert other.run(rows=False).status == "ok"


@pytest.mark.parametrize("way", COPIES)
def test_consent_goes_along_with_a_copy(way, tmp_path):
    scenario = Scenario(FIRST).set({"control.law": "process", "control.command": "exit 1"})
    with pytest.raises(Error, match="allow"):
        COPIES[way](scenario).run()
    with pytest.raises(Error, match="(?!.*allow)"):
        COPIES[way](scenario.allow_code()).run()
    with pytest.raises(TypeError):
        scenario.allow_code("no")


def test_groups_are_of_their_scenario():
    scenario = Scenario(FIRST)
    for way in (copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))):
        group = way(scenario.motor)
        group.voltage = 4
        assert group.voltage == 4 and scenario.motor.voltage == 1
    copy.copy(scenario.motor).voltage = 4
    assert scenario.motor.voltage == 4


@pytest.mark.parametrize("way", ["copy", "deepcopy", "pickle"])
def test_loops_say_that_they_cannot_be_copied(way):
    loop = Loop(Scenario(FIRST))
    with pytest.raises(TypeError, match="neither copied nor pickled: .*save_state"):
        COPIES[way](loop)
    gc.collect()
    assert loop.step() > 0


def made_runs():
    """A run of each origin."""
    scenario = Scenario("compare/hybrid").push_at(0.3, 1e-3)
    loop = Loop(scenario, command=True, rows=True)
    loop.command(1.5)
    loop.step_until(0.4)
    with pytest.raises(Error) as raised:
        scenario.run(controller=lambda reading: 1.0 if reading.time < 0.4 else math.nan)
    return [scenario.run(), scenario.run(rows=False), loop.run(), raised.value.run,
            scenario.run(controller=lambda reading: 1 + reading.force)]


@pytest.mark.parametrize("way", ["copy", "deepcopy", "pickle"])
def test_runs_and_batches_are_copied_and_pickled(way):
    for run in made_runs():
        other = COPIES[way](run)
        mine, its = json.loads(run.json), json.loads(other.json)
        # expectations are of the file, and not in a pickle
        assert {key: its.get(key) for key in mine if key != "expectations"} == \
               {key: mine[key] for key in mine if key != "expectations"}
        assert repr(other) == repr(run) and other.csv == run.csv
        assert other.events == run.events and np.array_equal(other.angles, run.angles)
        del run
        gc.collect()
        assert other["force"].sum() >= 0
    batch = Scenario(FIRST).batch({"motor.voltage": [1, 2, -5]})
    other = COPIES[way](batch)
    assert np.array_equal(other["peak_force_N"], batch["peak_force_N"], equal_nan=True)
    assert repr(other) == repr(batch) == "<Batch of 3 runs, 3 ok, over motor.voltage>"


def test_a_damaged_pickle_is_refused():
    data = pickle.dumps(Scenario(FIRST).run())
    with pytest.raises(Error, match="damaged"):
        pickle.loads(data[:-2000] + bytes([data[-2000] ^ 1]) + data[-1999:])


def test_errors_are_pickled_without_their_run():
    scenario = Scenario(FIRST)
    with pytest.raises(Error) as raised:
        scenario.run(controller=lambda reading: math.nan)
    again = pickle.loads(pickle.dumps(raised.value))
    assert str(again) == str(raised.value) and again.status == raised.value.status != 0


def test_what_does_not_exist_is_not_made():
    scenario = Scenario(FIRST)
    loop, run = Loop(scenario), scenario.run()
    refused = [
        (scenario, "motor", "scenario.motor.[a-z]+ = "), (scenario, "voltage", "'motor.voltage'"),
        (scenario, "moter", "'motor'"), (scenario, "run", "scenario.run.[a-z]+ = "),
        (scenario, "name", "cannot be set"), (scenario, "copy", "cannot be set"),
        (scenario.motor, "voltag", "'motor.voltage'"), (scenario.run, "duraton", "'run.duration'"),
        (loop, "command", "cannot be set"), (loop, "time", "cannot be set"),
        (loop, "ende", "'ended'"), (loop, "wanted_forc", "'wanted_force'"),
        (run, "peak_force_N", "cannot be set"), (run, "peek_force_N", "'peak_force_N'"),
        (run, "status", "cannot be set"), (scenario.batch({"motor.voltage": [1]}), "peak", "")]
    before = scenario.yaml
    for one, name, sentence in refused:
        with pytest.raises(AttributeError, match=sentence):
            setattr(one, name, 5)
        if "did you" in sentence or "'" in sentence:
            with pytest.raises(AttributeError, match=f"did you mean {sentence}"):
                getattr(one, name)
    loop.wanted_force = 2
    assert loop.wanted_force == 2 and scenario.yaml == before

    reading = Loop(scenario, command=True).read_sensors()
    with pytest.raises(AttributeError, match="'force'"):
        reading.forse
    for name in ("force", "forse"):
        with pytest.raises(AttributeError):
            setattr(reading, name, 1)
    for table, key, meant in ((impactlab.PARAMETERS, "motor.voltag", "motor.voltage"),
                              (impactlab.SIGNALS, "forse", "force"),
                              (impactlab.QUANTITIES, "peek_force_N", "peak_force_N"),
                              (scenario.batch({"motor.voltage": [1]}), "peek_force_N",
                               "peak_force_N")):
        with pytest.raises(KeyError, match=f"did you mean '{meant}'"):
            table[key]
    with pytest.raises(KeyError, match="'force'"):
        run.unit("forse")
    for one in (run, loop):
        with pytest.raises(Error, match="'force'"):
            one["forse"]


@pytest.mark.parametrize("answer, sentence", [
    ({"comand": 1}, "did you mean 'command'"), ({"command": 1, "mode": 7}, "mode"), ({}, "command"),
    ({"calculated_force": 1}, "command"), ({"command": True}, "command"), (True, "command"),
    (np.bool_(True), "command"), ("1", "command"), (None, "command"), ([1, 2], "command"),
    (1j, "command"), ({"command": 1, 5: 1}, "5"), (10**400, "large"), (b"1", "command")])
def test_answers_of_a_controller_are_volts(answer, sentence):
    with pytest.raises((TypeError, KeyError, ValueError), match=sentence):
        Scenario(FIRST).run(controller=lambda reading: answer)


def test_what_the_last_sample_raises_comes_out():
    scenario = Scenario(FIRST)
    times = []
    scenario.run(controller=lambda reading: times.append(reading.time) or 1.0)

    def late(reading):
        assert reading.time < times[-1]
        return 1.0
    with pytest.raises(AssertionError):
        scenario.run(controller=late)
    with pytest.raises(TypeError, match="function"):
        scenario.run(controller=5)


def test_readings_outlive_their_sample():
    kept = []
    Scenario(FIRST).run(controller=lambda reading: kept.append(reading) or 1.0)
    assert [r.time for r in kept] == sorted({r.time for r in kept})
    assert all(abs(r.encoder) < 1 for r in kept)


def test_a_controller_may_change_its_scenario():
    scenario = Scenario(FIRST)
    whole = scenario.run(controller=lambda reading: 1.0)

    def meddle(reading):
        scenario.motor.voltage = 5
        scenario.push_at(reading.time, 0.1)
        return 1.0
    assert scenario.run(controller=meddle).peak_force_N == whole.peak_force_N


def test_texts_end_where_they_end():
    scenario, loop = Scenario(FIRST), Loop(Scenario(FIRST), command=True)
    before = scenario.yaml
    cut = [lambda: Scenario(FIRST + "\0x"), lambda: Scenario.from_yaml("title: x\0\nmotor: 5\n"),
           lambda: scenario["motor.voltage\0x"],
           lambda: scenario.__setitem__("motor.voltage", "2\0 V"),
           lambda: scenario.__setitem__("motor.voltage\0", 2),
           lambda: scenario.set({"motor.voltage": "2\0"}),
           lambda: scenario.set({"motor.voltage\0": 2}),
           lambda: scenario.change_at(0.1, "motor.voltage\0", 2),
           lambda: scenario.change_at(0.1, "motor.voltage", "2\0"),
           lambda: scenario.batch({"motor.voltage\0": [1]}),
           lambda: loop["force\0"], lambda: loop.set_input("control.force\0", 1),
           lambda: loop.set_input("control.force", "1\0"), lambda: scenario.run()["force\0"]]
    for call in cut:
        with pytest.raises((ValueError, Error), match="."):
            call()
    assert scenario.yaml == before


def test_values_are_what_they_seem():
    scenario, loop = Scenario(FIRST), Loop(Scenario(FIRST), command=True)
    before = scenario.yaml
    for value in (True, np.bool_(False), None, b"2", [1], 1j, {}, object()):
        for give in (lambda: scenario.__setitem__("motor.voltage", value),
                     lambda: setattr(scenario.motor, "voltage", value),
                     lambda: scenario.set({"motor.voltage": value}),
                     lambda: scenario.change_at(0.1, "motor.voltage", value),
                     lambda: scenario.push_at(value, 1), lambda: scenario.push_at(0.1, value),
                     lambda: loop.command(value), lambda: loop.set_input("control.force", value),
                     lambda: loop.step_until(value), lambda: loop.push(value),
                     lambda: loop.restore_state(value)):
            with pytest.raises((TypeError, Error), match="."):
                give()
        if value != [1]:  # a grid of values is one
            with pytest.raises((TypeError, Error), match="."):
                scenario.batch({"motor.voltage": [value]})
    for value in (10**400, -10**400, math.nan, math.inf):
        for give in (lambda: scenario.__setitem__("motor.voltage", value),
                     lambda: loop.command(value), lambda: loop.push(value),
                     lambda: scenario.push_at(0.1, value), lambda: loop.step_until(value),
                     lambda: scenario.batch({"motor.voltage": [value]})):
            with pytest.raises((TypeError, ValueError, Error), match="."):
                give()
    for jobs in (-1, 2**32, 1.5, "2"):
        with pytest.raises((TypeError, ValueError)):
            scenario.batch({"motor.voltage": [1]}, jobs=jobs)
    for wrong in (scenario.run(), FIRST, None, 5):
        with pytest.raises(TypeError, match="Scenario"):
            Loop(wrong)
    for wrong in (FIRST, {}, 0, scenario.run()):
        with pytest.raises(TypeError, match="Scenario"):
            Environment(wrong)
    for wrong in (5, None, b"x", scenario):
        for call in (lambda: scenario[wrong], lambda: loop[wrong], lambda: scenario.run()[wrong],
                     lambda: scenario.set({wrong: 1}), lambda: Scenario.from_yaml(wrong)):
            with pytest.raises(TypeError, match="."):
                call()
    with pytest.raises(TypeError):
        impactlab.Run()
    with pytest.raises(Error, match="control.command=echo"):
        scenario.set({"control.command=echo": "x"})
    assert scenario.yaml == before and loop.time == 0 and loop.step() > 0


def test_lists_are_lists():
    lengths = [p.path for p in impactlab.PARAMETERS.values() if p.type == "list"]
    scenario = Scenario(FIRST)
    assert "arm.link_lengths" in lengths and scenario["arm.link_lengths"] == []
    scenario["arm.link_lengths"] = np.array([0.3, 0.2])
    assert scenario["arm.link_lengths"] == [0.3, 0.2] == scenario.copy().arm.link_lengths
    assert scenario.set({"arm.link_lengths": (0.25, 0.25)}).arm.link_lengths == [0.25, 0.25]
    with pytest.raises(TypeError):
        scenario["arm.link_lengths"] = [True, 0.1]


def test_errors_have_a_place():
    with pytest.raises(Error) as raised:
        Scenario.from_yaml("title: x\nmotor:\n  voltage: plenty\n")
    error = raised.value
    assert (error.line, error.column, error.parameter) == (3, 12, "motor.voltage")
    with pytest.raises(Error) as raised:
        Scenario().set({"motor.voltage": "plenty"})
    assert (raised.value.line, raised.value.parameter) == (0, "motor.voltage")


def test_scenarios_go_when_nobody_has_them():
    gone = weakref.ref(Scenario(FIRST))
    assert gone() is None
    run = Scenario(FIRST).run()
    force, watched = run["force"], weakref.ref(run)
    del run
    assert watched() is not None and force.max() > 1
    del force
    assert watched() is None


def test_threads_share_objects():
    scenario, loop, failures = Scenario(FIRST), Loop(Scenario(FIRST), command=True), []
    peak, stop = scenario.run(rows=False).peak_force_N, threading.Event()

    def repeat(action):
        try:
            while not stop.is_set():
                action()
        except BaseException as failure:
            failures.append(failure)

    def links():
        scenario["arm.links"] = 3
        frequencies, shapes = scenario.modes()
        assert len(frequencies) in (2, 3) and len(shapes) == len(frequencies)
        scenario["arm.links"] = 2

    state = loop.save_state()
    actions = [links, scenario.modes, lambda: scenario.push_at(0.9, 1e-9), scenario.copy,
               lambda: scenario.yaml, lambda: scenario.run(rows=False), loop.step,
               lambda: loop.restore_state(state), loop.read_sensors, loop.run]
    threads = [threading.Thread(target=repeat, args=(action,)) for action in actions]
    for thread in threads:
        thread.start()
    for _ in range(300):
        scenario.copy()
    stop.set()
    for thread in threads:
        thread.join()
    assert not failures
    scenario["arm.links"] = 2
    assert Scenario(FIRST).run(rows=False).peak_force_N == peak
