"""impactlab: impact and force control of a flexible robot arm.

    import impactlab

    scenario = impactlab.Scenario("corrected/first-impact")
    scenario.motor.voltage = 2
    run = scenario.run()
    print(run.peak_force_N, run["force"].max())

Units are SI; `impactlab.PARAMETERS`, `SIGNALS` and `QUANTITIES` say what everything is.
"""

from .environment import Box, Environment
from .library import Error, program, version
from .loop import Loop
from .run import QUANTITIES, SIGNALS, Batch, Event, Prediction, Quantity, Run, Signal
from .scenario import PARAMETERS, Parameter, Scenario, scenarios

__version__ = version()
__all__ = ["PARAMETERS", "QUANTITIES", "SIGNALS", "Batch", "Box", "Environment", "Error", "Event",
           "Loop", "Parameter", "Prediction", "Quantity", "Run", "Scenario", "Signal", "program",
           "scenarios", "version"]
