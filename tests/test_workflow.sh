#!/bin/bash
# From recordings to gains: every command of docs/howto/bench.md, in a copy of scenarios/workflow. The
# arm that was recorded is known here alone: the fitted parameters have to be its own, and the gains
# that were tuned on the fitted arm have to hold on it, whose law believes in the fitted one.
#
#   test_workflow.sh PROGRAM PROJECT
set -u
program=$(readlink -f "$1")
root=$(readlink -f "$2")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp -r "$root/scenarios/workflow/." "$folder"
cd "$folder" || exit 1
export LC_ALL=C.UTF-8
failures=0

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

commands=0
while read -r _ words; do
    eval "'$program' $words" >printed 2>&1 </dev/null || { fail "$words"; cat printed; }
    commands=$((commands + 1))
done < <(grep '^impactlab ' "$root/docs/howto/bench.md")
[ "$commands" = 7 ] || fail "$commands commands were found on the page"
for file in fit.pdf bode.pdf map.pdf tuned.pdf doubts.csv report/report.html; do
    [ -s "$file" ] || fail "$file is not written"
done

# the recorded arm, and what the law believes of it
"$program" show fitted.yaml --json fitted.json || fail "fitted.yaml"
python3 - fitted.json >told <<'END' || fail "the fitted parameters are not those of the recorded arm"
import json, sys
truth = {"arm.k2": 6.1, "arm.hub_inertia": 0.0066, "motor.stiction": 0.047,
         "motor.viscous_friction": 0.009, "motor.torque_constant": 2.15}
belief = {"arm.k2": "k2", "arm.hub_inertia": "inertia", "motor.stiction": "friction",
          "motor.torque_constant": "torque"}
listed = json.load(open(sys.argv[1]))["parameters"]
fitted = {path: listed[path] for path in truth}
for path, value in truth.items():
    print("--set", f"{path}={value}")
    if path in belief:
        print("--set", f"belief.{belief[path]}_factor={fitted[path] / value}")
sys.exit(any(abs(fitted[path] / value - 1) > 0.01 for path, value in truth.items()))
END
for file in fitted tuned; do
    # shellcheck disable=SC2046
    "$program" run "$file.yaml" $(cat told) --quiet --json "$file.json" || fail "$file.yaml on the recorded arm"
done
python3 - fitted.json tuned.json <<'END' || fail "the tuned gains do not hold on the recorded arm"
import json, sys
before, after = (json.load(open(path)) for path in sys.argv[1:])
print("overshoot", before["force_over_command_N"], after["force_over_command_N"],
      "settling", before["settling_time_s"], after["settling_time_s"])
sys.exit(after["separations"] > 0 or after["force_over_command_N"] > before["force_over_command_N"] / 3
         or after["settling_time_s"] > before["settling_time_s"] / 3)
END
echo "$commands commands, $failures failures"
[ "$failures" = 0 ]
