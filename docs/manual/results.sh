#!/bin/bash
# The manual's result tables, each made by the command above it, in one page whose footer names the
# commit. It takes some minutes.
#
#   results.sh SOURCE_ROOT PROGRAM OUTPUT.md
set -euo pipefail
source=$1
program=$2
output=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin"
ln -s "$program" "$work/bin/impactlab"
PATH=$work/bin:$PATH

# table TITLE COMMAND: a section with what the command prints, as Markdown where it is that
table() {
    printf '\n## %s\n\n    %s\n\n' "$1" "${2//$'\n'/$'\n    '}"
    (cd "$source" && bash -c "$2") >"$work/said" </dev/null
    if grep -q '^|---' "$work/said"; then
        cat "$work/said"
    else
        sed 's/^/    /' "$work/said"
    fi
    echo "$1" >&2
}

{
    echo '# Results'
    table 'All laws on one impact' 'impactlab compare --quiet --markdown - \
compare/{open-loop,hybrid,hybrid-printed,force-pd,force-integral,reverse-torque,speed-limit,bang-bang} \
compare/{discontinuous,recovering,inverse-dynamics,observer,least-time,touch,touch-limit}'
    table 'Wrong beliefs' 'impactlab robust compare/observer --quiet --markdown - \
--laws hybrid,force-pd,impedance,admittance,recovering,touch,observer'
    for set in cases second-cases third-cases; do
        table "One thing at a time: $set.set" "impactlab robust compare/observer --quiet --markdown - \\
--over scenarios/sets/$set.set --against hybrid"
    done
    table 'The least time in doubt' 'impactlab robust compare/least-time --quiet --markdown - \
--over scenarios/sets/cases.set'
    table 'Touch and hybrid by force' 'impactlab compare compare/hybrid compare/touch --quiet --markdown - \
--vary control.force=0.5,1,2,3,4 --columns peak_force_N,overshoot_percent,settling_time_s,steady_error_N'
    table 'The transition time' 'impactlab compare compare/hybrid --quiet --markdown - \
--vary control.transition_time=0.05,0.1,0.15,0.2,0.25,0.35,0.5,0.7'
    table 'The sampling rate' 'impactlab compare compare/sampling-rate compare/hybrid --quiet --markdown - \
--vary control.delay_periods=0,1 --vary control.rate=20,50,100,200,500,2000 \
--columns peak_force_N,settling_time_s,separations'
    table 'The impact angle' 'impactlab compare compare/hybrid --quiet --markdown - \
--vary control.impact_angle=told,film,accelerometer --vary belief.wall_error=-0.02,0,0.02 \
--columns peak_force_N,settling_time_s,steady_error_N'
    table 'Force sensors' 'impactlab compare --quiet --markdown - --vary control.rate=200,500,1000,2000 \
compare/force-pd compare/force-pd-piezo compare/observer'
    table 'The look-up table' 'impactlab calibrate compare/twelve-links'
    table 'Tables 4.1 to 4.3' 'impactlab tables'
    table 'Methods of integration' 'impactlab study methods corrected/first-impact'
    table 'How many links' 'impactlab study links'
    table 'What a sensor would see' 'impactlab study links corrected/plane-wall-fast'
    table 'Speed' 'impactlab bench'
    table 'Long checks' 'bash tests/test_counts.sh .'
    printf '\n---\n%s, commit %s, %s\n' "$(impactlab --version)" \
        "$(git -C "$source" rev-parse --short HEAD 2>/dev/null || echo unknown)" "$(date -u +%F)"
} >"$work/results.md"
mv "$work/results.md" "$output"
echo "the results: $output"
