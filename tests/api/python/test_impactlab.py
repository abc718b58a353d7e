"""The Python package over the shared library. Tests assert results, never time."""

import json
import math

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


def test_states_are_bytes():
    loop = Loop(Scenario("compare/hybrid"))
    loop.step_until(0.3)
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
    svg = Scenario(FIRST).run()._repr_svg_()
    assert svg is not None and "<svg" in svg[:500]


def test_frames():
    pytest.importorskip("pandas")
    frame = Scenario(FIRST).run().to_dataframe()
    assert frame.attrs["units"]["force"] == "N" and frame["force"].max() > 1


def test_code_is_not_run_unasked(tmp_path):
    mark = tmp_path / "started"
    scenario = Scenario(FIRST).set({"control.law": "process", "control.command": f"touch {mark}"})
    with pytest.raises(Error, match="allow"):
        scenario.run()
    assert not mark.exists()
