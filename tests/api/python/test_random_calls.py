"""Random calls of the Python package with arguments of every kind, refused or not, one after the other.

Each returns or raises with a sentence, and a scenario or loop that refused is as it was. Beyond that
nothing may happen: an end of the process is what this looks for. IMPACTLAB_RANDOM_CALLS says how many.
"""

import copy
import gc
import math
import os
import pickle
import random

import numpy as np
import pytest

import impactlab
from impactlab import Batch, Environment, Error, Loop, Run, Scenario

CALLS = int(os.environ.get("IMPACTLAB_RANDOM_CALLS", "3000"))
NAMES = ["corrected/first-impact", "compare/hybrid", "compare/hybrid-printed-arm"]
REFUSALS = (Error, TypeError, ValueError, AttributeError, KeyError, IndexError)
#: takes too long at any value, or starts what takes too long; files would be written
LEFT_OUT = {"arm.links", "method.step", "run.duration", "method.tolerance", "control.rate"}
PATHS = [path for path in impactlab.PARAMETERS if path not in LEFT_OUT]
WORDS = [*PATHS[::7], *impactlab.SIGNALS, "peak_force_N", "motor.voltag", "", "force\0", "ü", "a=b", "\udcff"]


def anything(rng):
    """An argument: of the right kind now and then."""
    return rng.choice([
        lambda: rng.uniform(-3, 3), lambda: rng.choice([0, 1, -1, 2**31, 2**63, 10**400]),
        lambda: rng.choice([math.nan, math.inf, -math.inf, -0.0, 1e308, 5e-324]),
        lambda: rng.choice(WORDS), lambda: rng.choice(["1 V", "0.1 rad", "plane", "none", "\0", "x" * 500]),
        lambda: rng.choice([True, False, None, b"", b"1", 1j, (), [], {}, object(), print]),
        lambda: [anything(rng) for _ in range(rng.randrange(3))], lambda: {anything_hashable(rng): anything(rng)},
        lambda: np.array([rng.uniform(0, 2)]), lambda: np.float32(1), lambda: np.int8(3), lambda: np.str_("1"),
    ])()


def anything_hashable(rng):
    return rng.choice([rng.choice(WORDS), 5, None, True, b"x", (1,)])


def path(rng):
    return rng.choice(PATHS) if rng.random() < 0.7 else anything(rng)


class Hand:
    """What a caller has in hand, and what it may do with each."""

    def __init__(self, rng):
        self.rng = rng
        self.scenario = Scenario(rng.choice(NAMES))
        self.scenario["run.duration"] = 0.1
        self.loop = self.run = self.state = self.view = None
        self.new_loop()

    def new_loop(self):
        loop = Loop(self.scenario, command=self.rng.random() < 0.5, rows=self.rng.random() < 0.5)
        self.loop, self.state = loop, loop.save_state()

    # of a scenario

    def assign(self):
        self.scenario[path(self.rng)] = anything(self.rng)

    def ask(self):
        self.scenario[path(self.rng)]

    def set_several(self):
        self.scenario.set({str(path(self.rng)): anything(self.rng) for _ in range(self.rng.randrange(3))})

    def set_anything(self):
        self.scenario.set(anything(self.rng))

    def attribute(self):
        one = self.rng.choice([self.scenario, self.scenario.motor, self.scenario.wall, self.loop, self.run])
        name = self.rng.choice([n for n in dir(one) if not n.startswith("_")] + ["voltag", "peak"])
        setattr(one, name, anything(self.rng))

    def change(self):
        self.scenario.change_at(anything(self.rng), path(self.rng), anything(self.rng))

    def push_later(self):
        self.scenario.push_at(anything(self.rng), anything(self.rng))

    def twin(self):
        way = self.rng.choice([copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
        one = self.rng.choice([self.scenario, self.loop, self.run])
        other = way(one)
        assert other.yaml == one.yaml
        self.scenario = other

    def open(self):
        Scenario(anything(self.rng))

    def parse(self):
        text = self.scenario.yaml
        at = self.rng.randrange(len(text))
        Scenario.from_yaml(text[:at] + self.rng.choice(["", ":", "[", "\0", "ü", "- "]) + text[at + 1:])

    def modes(self):
        self.scenario.modes(*self.rng.choices(["free", "locked", "pinned", anything(self.rng)], k=2))

    def batch(self):
        given = {path(self.rng): self.rng.choice([[1, 2], anything(self.rng)])}
        batch = self.scenario.batch(given, self.rng.choice([0, 1, 2, anything(self.rng)]))
        assert isinstance(batch, Batch) and set(batch.status) <= {"ok", "inaccurate", "failed"}

    # of runs

    def execute(self):
        self.run = self.scenario.run(rows=self.rng.random() < 0.8)

    def control(self):
        readings = []

        def law(reading):
            readings.append(reading)
            return self.rng.choice([1.0, 0.5, {"command": 1}, anything(self.rng)])
        self.run = self.scenario.run(controller=self.rng.choice([law, law, anything(self.rng)]))
        assert all(reading.time <= 0.1 for reading in readings)

    def look(self):
        name = self.rng.choice([*impactlab.SIGNALS, anything(self.rng)])
        self.view = self.run[name]
        assert isinstance(self.run, Run) and self.view.sum() is not None

    def tell(self):
        self.rng.choice([lambda: self.run.json, lambda: self.run.csv, lambda: self.run.events,
                         lambda: self.run.predictions, lambda: self.run.angles.sum(), lambda: repr(self.run),
                         lambda: self.run.unit(anything(self.rng))])()

    # of a loop

    def step(self):
        self.loop.step()

    def until(self):
        self.loop.step_until(anything(self.rng))

    def feed(self):
        self.rng.choice([self.loop.command, self.loop.push])(anything(self.rng))

    def give(self):
        self.loop.set_input(path(self.rng), anything(self.rng))

    def read(self):
        self.loop[self.rng.choice([*impactlab.SIGNALS, anything(self.rng)])]
        assert self.loop.read_sensors().time <= 0.1

    def restore(self):
        state = bytearray(self.state)
        if self.rng.random() < 0.5:
            state[self.rng.randrange(len(state))] ^= 1 << self.rng.randrange(8)
        self.loop.restore_state(self.rng.choice([state, bytes(state), anything(self.rng)]))
        assert bytes(state) == self.state == self.loop.save_state()

    def result(self):
        self.run = self.loop.run()

    def again(self):
        gc.collect()
        self.new_loop()

    # of an environment

    def episode(self):
        environment = Environment(self.rng.choice([self.scenario, self.scenario, anything(self.rng)]))
        environment.reset(seed=self.rng.choice([1, anything(self.rng)]), options=self.rng.choice([None, anything(self.rng)]))
        for _ in range(3):
            environment.step(self.rng.choice([1.0, np.array([0.5]), anything(self.rng)]))

    def forget(self):
        self.scenario, self.run = self.scenario.copy(), self.scenario.run(rows=False)
        gc.collect()


# what leaves a scenario and a loop as they were where it is refused
CHANGES = {"assign", "set_several", "set_anything", "attribute", "change", "push_later", "feed", "give", "restore"}


@pytest.mark.parametrize("seed", range(max(1, CALLS // 500)))
def test_random_calls(seed):
    rng = random.Random(seed)
    hand = Hand(rng)
    hand.run = hand.scenario.run()
    actions = [name for name, value in vars(Hand).items() if callable(value) and name[0] != "_" and name != "new_loop"]
    refused = 0
    for _ in range(min(CALLS, 500)):
        name = rng.choice(actions)
        before = hand.scenario.yaml, hand.loop.save_state()
        try:
            getattr(hand, name)()
        except REFUSALS as refusal:
            refused += 1
            assert str(refusal)
            # what ended the run of a loop stays
            ended = isinstance(refusal, Error) and refusal.status > 2
            if name in CHANGES and not ended:
                assert (hand.scenario.yaml, hand.loop.save_state()) == before, name
    assert refused > 50
