// The table of synonyms. Endings do not matter, words are compared by their stems.
#include "ui/manual/synonyms.h"

const synonym_row synonym_table[] = {
    // the arm
    {"gravity gravitational weight vertical upright sag", "tilt"},
    {"rod bar strip ruler cantilever manipulator", "beam"},
    {"segments elements discretization mesh nodes", "links"},
    {"gearbox gearhead reducer transmission", "gear"},
    {"young modulus flexural rigidity thickness", "EI|bending stiffness"},
    {"material aluminium aluminum steel rubber carbon", "bending stiffness"},
    {"payload load gripper", "tip mass"},
    {"eigenfrequency eigenvalue resonance resonant vibration",
     "natural frequencies|modes"},
    {"deflection flex flexing", "bending"},

    // motor and wall
    {"actuator servo", "motor"},
    {"saturation saturated clipped", "limit"},
    {"obstacle environment surface object", "wall"},
    {"elastic compliant compliance flexible", "soft|stiffness"},
    {"collision collide strike", "impact|contact"},
    {"rebound bouncing", "restitution|bounce"},
    {"lag latency", "delay"},
    {"aerodynamic", "air drag"},

    // control
    {"pid pd proportional derivative", "force-pd|gains"},
    {"integral integrator", "force-integral"},
    {"controller regulator algorithm", "law|controller"},
    {"setpoint target desired reference", "commanded force|control.force"},
    {"robustness uncertainty uncertain perturbation mismatch", "robust|beliefs"},
    {"montecarlo monte carlo tolerance", "sample|draws|robust"},
    {"optimise optimize optimisation optimization optimizer", "tune"},
    {"bode nyquist stability unstable", "margins|linear"},

    // the program
    {"undo revert", "u takes"},
    {"docker podman kubernetes", "container"},
    {"windows wsl macos mac apple osx", "systems"},
    {"virtualenv venv conda pip", "Python package"},
    {"simulink fmi modelica ros", "fmu|program of others"},
    {"computer pc laptop", "machines"},
    {"identification estimation", "identify|fit"},
    {"mistakes slips", "errata|errors"},
    {"matlab", "octave|mat"},
    {"pandas polars duckdb spark arrow pyarrow dataframe", "parquet|pandas"},
    {"resample resampled equidistant fft", "uniform steps"},
    {"excel spreadsheet libreoffice", "spreadsheet|csv"},
    {"cluster hpc parallel cores", "machines|jobs|processors"},
    {"performance slow", "speed"},
    {"movie video gif mp4 animation", "animate|films"},
    {"image chart graph diagram", "figure|picture"},
    {"fonts letters", "font"},
    {"overlay superimpose experimental experiment", "measured data"},
    {"shortcut hotkey keyboard", "keys"},
    {"many several", "sweep"},
    {"random", "seed"},
    {"reproduce reproducible deterministic", "same bytes"},
    {"licence license copyright", "licence"},
    {"citation bibtex doi", "cite"},
    {"tutorial beginner introduction learn", "first steps|lessons"},
    {"accuracy accurate precision converged", "residual|converge|inaccurate"},
    {"solver ode integrator", "method"},
    {"timestep dt", "step"},
    {"jupyter", "notebook"},
    {"crashed", "recovery"},
};
const int synonym_count = sizeof synonym_table / sizeof synonym_table[0];
