"""What a checker of types must let pass and, in lines that end with `# wrong`, must not."""

import impactlab

s = impactlab.Scenario("corrected/first-impact", motor__voltage=2)
s.motor.voltage = 2
s.motor.voltage = "2 V"
s.arm.model = "printed"
s.arm.joint_stiffness = [5.0, 5.0]
s.run.duration = s.motor.voltage + s.arm.links
run = s.run(controller=lambda reading: 1 + 0.1 * (1 - reading.force))
peak: float = run.peak_force_N + run["force"].max()
loop = impactlab.Loop(s, command=True)
loop.wanted_force = loop["force"] + loop.signals["force"] + loop.read_sensors().force

s.motor.voltag = 2  # wrong
s.motr.voltage = 2  # wrong
print(s.motor.voltag)  # wrong
s.arm.model = "printd"  # wrong
s.motor.voltage = [1]  # wrong
s.arm.links = 1.5  # wrong
print(s.run().peek_force_N)  # wrong
run.peak_force_N = 2  # wrong
loop.stepp()  # wrong
