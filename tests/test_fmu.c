// FMUs as an importer takes them: unpacked by another program, their binary loaded, their
// variables found by the names that the description gives them. Every signal is compared
// with that of a loop that is cut at the same instants.
//
//     test_fmu [COMPILER]    the binary that is inside, or one made of the sources inside
#include <dlfcn.h>

#include "src/exchange/fmu/fmi2/fmi2Functions.h"
#include "src/exchange/fmu/fmu_export.h"
#include "tests/scenario_fixture.h"

// The compiler of the sources, NULL to take the binary, and the folder of its objects.
static const char *compiler;
static char objects[] = "/tmp/impactlab-objects-XXXXXX";

// --- an importer -----------------------------------------------------------------------

typedef struct fmu {
    char *description;
    void *library;
    fmi2Component c;
    char guid[64];
    fmi2ValueReference signals[SIGNALS_AT_MOST];
} fmu;

// What the last failure was, as the FMU said it.
static char said[1024];

static void listen(void *environment, fmi2String instance, fmi2Status code,
                   fmi2String category, fmi2String message, ...)
{
    (void)environment;
    (void)instance;
    assert_string_equal(category, "logStatusError");
    assert_int_equal(code, fmi2Error);
    va_list list;
    va_start(list, message);
    vsnprintf(said, sizeof said, message, list);
    va_end(list);
}

static const fmi2CallbackFunctions callbacks = {listen, calloc, free, NULL, NULL};

// A function of the FMU: CALL(&m, fmi2Reset)(m.c).
#define CALL(m, name) (__extension__(name##TYPE *) dlsym((m)->library, #name))
#define OK(...)                                                                          \
    do {                                                                                 \
        said[0] = '\0';                                                                  \
        fail_if((__VA_ARGS__) != fmi2OK, "%s: %s", #__VA_ARGS__, said);                  \
    } while (0)
#define REFUSES(says, ...)                                                               \
    do {                                                                                 \
        said[0] = '\0';                                                                  \
        assert_int_equal((__VA_ARGS__), fmi2Error);                                      \
        fail_if(strstr(said, (says)) == NULL, "'%s' does not say '%s'", said, (says));   \
    } while (0)

static void do_shell(const char *command)
{
    fail_if(system(command) != 0, "%s", command);
}

// Writes the archive and unpacks it into a folder of the test's.
static void write_and_unpack(const scenario *s, const char *folder)
{
    fmu_export *e;
    DONE(fmu_export_create(&e, s, NULL, &f));
    FILE *file = fopen(formatted("%s/%s.fmu", test_folder, folder), "wb");
    assert_non_null(file);
    DONE(fmu_export_write(e, file, &f));
    assert_int_equal(fclose(file), 0);
    free(e);
    do_shell(formatted("python3 -m zipfile -e %s/%s.fmu %s/%s", test_folder, folder,
                       test_folder, folder));
}

static fmi2ValueReference reference(const fmu *m, const char *name)
{
    const char *at = strstr(m->description, formatted("name=\"%s\" valueRef", name));
    fail_if(at == NULL, "no variable %s", name);
    return (fmi2ValueReference)atoi(strstr(at, "valueReference=\"") + 16);
}

// A new instance, before its initialisation.
static fmi2Component instance_of(const fmu *m)
{
    const fmi2Component c = CALL(m, fmi2Instantiate)("arm", fmi2CoSimulation, m->guid, "",
                                                     &callbacks, fmi2False, fmi2False);
    fail_if(c == NULL, "%s", said);
    return c;
}

// Puts what a compiler makes of the sources inside in the place of the binary. Objects
// are kept from one case to the next by the text of their source and the headers, since
// most files are the same in every FMU.
static void compile_sources(const char *place)
{
    do_shell(
        formatted("cd %s/sources && linked= && for source in *.c; do "
                  "  object=%s/$(cat $source *.h | md5sum | cut -c -32).o; "
                  "  [ -e $object ] || %s -O1 -fPIC -c -o $object $source || exit 1; "
                  "  linked=\"$linked $object\"; "
                  "done; rm ../binaries/linux64/* && "
                  "%s -shared -o ../binaries/linux64/arm.so $linked -lm",
                  place, objects, compiler, compiler));
}

static fmu imported(const scenario *s, const char *folder)
{
    write_and_unpack(s, folder);
    const char *place = formatted("%s/%s", test_folder, folder);
    if (compiler != NULL) {
        compile_sources(place);
    }
    do_shell(formatted("mv %s/binaries/linux64/*.so %s/arm.so", place, place));
    fmu m = {.description = file_text(formatted("%s/modelDescription.xml", place)),
             .library = dlopen(formatted("%s/arm.so", place), RTLD_NOW | RTLD_LOCAL)};
    fail_if(m.library == NULL, "%s", dlerror());
    const char *guid = strstr(m.description, "guid=\"");
    assert_non_null(guid);
    assert_int_equal(sscanf(guid, "guid=\"%60[^\"]", m.guid), 1);
    for (int i = 0; i < signal_count; i++) {
        m.signals[i] = reference(&m, signal_table[i].name);
    }
    m.c = instance_of(&m);
    return m;
}

static void let_go(fmu *m)
{
    CALL(m, fmi2FreeInstance)(m->c);
    dlclose(m->library);
    free(m->description);
}
#define KEPT_FMU(name) SCOPED(let_go) fmu name

static fmi2Status set(const fmu *m, fmi2Component c, const char *name, double value)
{
    const fmi2ValueReference v = reference(m, name);
    return CALL(m, fmi2SetReal)(c, &v, 1, &value);
}

static double get(const fmu *m, fmi2Component c, const char *name)
{
    const fmi2ValueReference v = reference(m, name);
    double value;
    OK(CALL(m, fmi2GetReal)(c, &v, 1, &value));
    return value;
}

static void initialise(const fmu *m, fmi2Component c, double stop)
{
    OK(CALL(m, fmi2SetupExperiment)(c, fmi2False, 0, 0, fmi2True, stop));
    OK(CALL(m, fmi2EnterInitializationMode)(c));
    OK(CALL(m, fmi2ExitInitializationMode)(c));
}

// One step of 1 ms, the i-th.
#define STEP 1e-3
static fmi2Status step(const fmu *m, fmi2Component c, int i)
{
    return CALL(m, fmi2DoStep)(c, i * STEP, STEP, fmi2True);
}

// --- the loop beside it ----------------------------------------------------------------

// Counts the bits in which two numbers differ.
static int bits_between(double a, double b)
{
    uint64_t x, y;
    memcpy(&x, &a, sizeof x);
    memcpy(&y, &b, sizeof y);
    return isnan(a) && isnan(b) ? 0 : __builtin_popcountll(x ^ y);
}

// Every signal of the FMU is the row's, to the last bit.
static void check_row(const fmu *m, fmi2Component c, const sample *row)
{
    double values[SIGNALS_AT_MOST];
    OK(CALL(m, fmi2GetReal)(c, m->signals, (size_t)signal_count, values));
    for (int i = 0; i < signal_count; i++) {
        const double value = values[i];
        const double expected = signal_value(row, i);
        fail_if(bits_between(value, expected) != 0, "%s = %.17g, expected %.17g at %g s",
                signal_table[i].name, value, expected, row->time);
    }
}

static run_loop *loop_of(const scenario *s, bool commanded)
{
    run_loop *l;
    const loop_options options = {.commanded = commanded};
    DONE(loop_create(&l, s, &options, &f));
    return l;
}

static void check_step(const fmu *m, fmi2Component c, run_loop *l, int i)
{
    OK(step(m, c, i));
    DONE(loop_until(l, i * STEP + STEP, &f));
    const sample row = loop_row(l);
    check_row(m, c, &row);
}

// --- cases -----------------------------------------------------------------------------

TEST_IN_FOLDER(signals_have_the_bits_of_a_loop)
{
    for (EACH_TEXT(name, "corrected/first-impact", "compare/hybrid",
                   "compare/twelve-links", "thesis/fig-3-4")) {
        KEPT_SCENARIO(s) = shipped_with(*name, "run.duration=2");
        KEPT_LOOP(l) = loop_of(&s, false);
        KEPT_FMU(m) = imported(&s, strrchr(*name, '/') + 1);
        initialise(&m, m.c, 2);
        const sample start = loop_row(l);
        check_row(&m, m.c, &start);
        for (int i = 0; i < 2000; i++) {
            check_step(&m, m.c, l, i);
        }
        REFUSES("the run ends at 2 s", step(&m, m.c, 2000));
    }
}

TEST_IN_FOLDER(inputs_act_at_the_next_step)
{
    KEPT_SCENARIO(s) = shipped_with("corrected/first-impact", "run.duration=1");
    KEPT_LOOP(l) = loop_of(&s, false);
    KEPT_FMU(m) = imported(&s, "inputs");
    initialise(&m, m.c, 1);
    for (int i = 0; i < 1000; i++) {
        // the same value again and again is one push and one change
        if (i >= 300) {
            OK(set(&m, m.c, "motor.voltage", 2.5));
            OK(set(&m, m.c, "push", i < 500 ? -0.02 : 0));
        }
        if (i == 300) {
            const double force = get(&m, m.c, "voltage");
            check_close(force, 1, 0);
            DONE(loop_set_number(l, PARAMETER_INDEX(motor.voltage), 2.5, &f));
            DONE(loop_push(l, -0.02, &f));
        }
        check_step(&m, m.c, l, i);
    }
    check_close(get(&m, m.c, "motor.voltage"), 2.5, 0);
}

TEST_IN_FOLDER(the_importer_commands_the_motor)
{
    KEPT_SCENARIO(s) = shipped_with("compare/hybrid", "run.duration=0.5");
    KEPT_LOOP(l) = loop_of(&s, true);
    KEPT_FMU(m) = imported(&s, "commanded");
    const fmi2ValueReference commanded = reference(&m, "commanded");
    const fmi2Boolean yes = fmi2True, no = fmi2False;
    OK(CALL(&m, fmi2SetBoolean)(m.c, &commanded, 1, &yes));
    initialise(&m, m.c, 0.5);
    REFUSES("holds from the start", CALL(&m, fmi2SetBoolean)(m.c, &commanded, 1, &no));
    for (int i = 0; i < 500; i++) {
        const double volts = 1 + 0.5 * (i / 100);
        OK(set(&m, m.c, "motor_command", volts));
        loop_command(l, volts);
        check_step(&m, m.c, l, i);
    }

    // a command that nobody takes is not ignored in silence
    OK(CALL(&m, fmi2Reset)(m.c));
    initialise(&m, m.c, 0.5);
    OK(set(&m, m.c, "motor_command", 1));
    REFUSES("expected commanded = true", step(&m, m.c, 0));
}

// Parameters are those of --set, whatever else is handed back unchanged.
TEST_IN_FOLDER(parameters_act_as_when_set)
{
    KEPT_SCENARIO(s) = shipped("compare/twelve-links");
    KEPT_SCENARIO(other) =
        shipped_with("compare/twelve-links",
                     "run.duration=0.3 arm.tip_mass=0.02 arm.links=3 wall.kind=plane "
                     "sensor.ideal=true arm.joint_stiffness=[8,9,10]");
    KEPT_LOOP(l) = loop_of(&other, false);
    KEPT_FMU(m) = imported(&s, "parameters");
    for (int i = 0; i < parameter_count; i++) {
        const fmi2ValueReference v = (fmi2ValueReference)i;
        double value;
        if (parameter_table[i].type == PARAMETER_REAL) {
            OK(CALL(&m, fmi2GetReal)(m.c, &v, 1, &value));
            if (isfinite(value)) {
                OK(CALL(&m, fmi2SetReal)(m.c, &v, 1, &value));
            }
        }
    }

    const fmi2ValueReference links = reference(&m, "arm.links"),
                             kind = reference(&m, "wall.kind"),
                             ideal = reference(&m, "sensor.ideal"),
                             list = reference(&m, "arm.joint_stiffness");
    const fmi2Integer three = 3, plane = WALL_PLANE;
    const fmi2Boolean yes = fmi2True;
    const fmi2String stiffness = "[8,9,10]";
    OK(CALL(&m, fmi2SetInteger)(m.c, &links, 1, &three));
    OK(set(&m, m.c, "arm.tip_mass", 0.02));
    OK(CALL(&m, fmi2SetInteger)(m.c, &kind, 1, &plane));
    OK(CALL(&m, fmi2SetBoolean)(m.c, &ideal, 1, &yes));
    OK(CALL(&m, fmi2SetString)(m.c, &list, 1, &stiffness));
    initialise(&m, m.c, 0.3);
    for (int i = 0; i < 300; i++) {
        check_step(&m, m.c, l, i);
    }
    REFUSES("cannot change during a run",
            CALL(&m, fmi2SetInteger)(m.c, &links, 1, &plane));
}

TEST_IN_FOLDER(states_come_back_in_any_instance)
{
    for (EACH_TEXT(name, "corrected/first-impact", "compare/hybrid",
                   "compare/twelve-links")) {
        KEPT_SCENARIO(s) = shipped_with(*name, "run.duration=1 arm.tip_mass=0.01");
        KEPT_LOOP(l) = loop_of(&s, false);
        KEPT_SCENARIO(lighter) = shipped(*name);
        KEPT_FMU(m) = imported(&lighter, strrchr(*name, '/') + 1);
        const fmi2Component one = m.c, two = instance_of(&m);
        OK(set(&m, one, "arm.tip_mass", 0.01));
        initialise(&m, one, 1);
        initialise(&m, two, 0.7);
        for (int i = 0; i < 300; i++) {
            check_step(&m, one, l, i);
            OK(step(&m, two, i)); // of another arm
        }

        // saved at 0.3 s, as a state and as bytes
        fmi2FMUstate saved = NULL, copy = NULL;
        size_t size;
        OK(CALL(&m, fmi2GetFMUstate)(one, &saved));
        OK(CALL(&m, fmi2SerializedFMUstateSize)(one, saved, &size));
        SCOPED(free_kept) char *bytes = malloc(size);
        OK(CALL(&m, fmi2SerializeFMUstate)(one, saved, bytes, size));
        sample kept[200];
        for (int i = 300; i < 500; i++) {
            check_step(&m, one, l, i);
            kept[i - 300] = loop_row(l);
        }

        // back in the first, from bytes in the second, both at once
        OK(CALL(&m, fmi2DeSerializeFMUstate)(two, bytes, size, &copy));
        OK(CALL(&m, fmi2SetFMUstate)(one, saved));
        OK(CALL(&m, fmi2SetFMUstate)(two, copy));
        for (int i = 300; i < 500; i++) {
            OK(step(&m, one, i));
            OK(step(&m, two, i));
            check_row(&m, one, &kept[i - 300]);
            check_row(&m, two, &kept[i - 300]);
        }

        // damaged bytes are refused
        random_generator g = seeded(7);
        for (int i = 0; i < 200; i++) {
            fmi2FMUstate none = NULL;
            const size_t at = (size_t)(random_uniform(&g) * (double)size);
            bytes[at] ^= 1;
            REFUSES("damaged",
                    CALL(&m, fmi2DeSerializeFMUstate)(two, bytes, size, &none));
            bytes[at] ^= 1;
            REFUSES("damaged", CALL(&m, fmi2DeSerializeFMUstate)(two, bytes, at, &none));
        }
        OK(CALL(&m, fmi2FreeFMUstate)(one, &saved));
        OK(CALL(&m, fmi2FreeFMUstate)(one, &copy));
        assert_null(saved);
        CALL(&m, fmi2FreeInstance)(two);
    }
}

TEST_IN_FOLDER(files_travel_inside)
{
    put_file(formatted("%s/path.csv", test_folder),
             "time[s],place[m]\n0,0\n0.1,0.002\n0.2,0.001\n");
    put_file(formatted("%s/volts.csv", test_folder), "t,command\n0,1\n0.2,3\n");
    KEPT_SCENARIO(s) = shipped_with(
        "corrected/first-impact",
        formatted("run.duration=0.5 wall.motion=file wall.motion_file=%s/path.csv "
                  "control.law=playback control.playback_file=%s/volts.csv",
                  test_folder, test_folder));
    KEPT_LOOP(l) = loop_of(&s, false);
    KEPT_FMU(m) = imported(&s, "files");
    do_shell(formatted("rm %s/*.csv", test_folder));
    initialise(&m, m.c, 0.5);
    for (int i = 0; i < 500; i++) {
        check_step(&m, m.c, l, i);
    }
}

TEST_IN_FOLDER(what_cannot_be_is_said)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    KEPT_FMU(m) = imported(&s, "refusals");
    const fmi2ValueReference nothing = 999;
    double value;
    assert_string_equal(CALL(&m, fmi2GetVersion)(), "2.0");
    said[0] = '\0';
    assert_null(CALL(&m, fmi2Instantiate)("arm", fmi2CoSimulation, "{0}", "", &callbacks,
                                          fmi2False, fmi2False));
    assert_non_null(strstr(said, "guid"));
    assert_null(CALL(&m, fmi2Instantiate)("arm", fmi2ModelExchange, m.guid, "",
                                          &callbacks, fmi2False, fmi2False));
    assert_non_null(strstr(said, "co-simulation"));
    REFUSES("999", CALL(&m, fmi2GetReal)(m.c, &nothing, 1, &value));
    REFUSES("not finite", set(&m, m.c, "arm.k2", (double)NAN));
    REFUSES("arm.k2", set(&m, m.c, "arm.k2", -1));
    REFUSES("starts at 0 s",
            CALL(&m, fmi2SetupExperiment)(m.c, fmi2False, 0, 1, fmi2False, 0));
    REFUSES("initialisation", step(&m, m.c, 0));

    // what does not go together is said at the start, and can be put right
    OK(set(&m, m.c, "arm.link_inertia", 0.001));
    const fmi2ValueReference links = reference(&m, "arm.links");
    const fmi2Integer three = 3, two = 2;
    OK(CALL(&m, fmi2SetInteger)(m.c, &links, 1, &three));
    OK(CALL(&m, fmi2SetupExperiment)(m.c, fmi2False, 0, 0, fmi2False, 0));
    REFUSES("arm.link_inertia", CALL(&m, fmi2ExitInitializationMode)(m.c));
    OK(CALL(&m, fmi2SetInteger)(m.c, &links, 1, &two));
    OK(CALL(&m, fmi2ExitInitializationMode)(m.c));

    OK(step(&m, m.c, 0));
    REFUSES("a saved state", step(&m, m.c, 0));
    REFUSES("forward", CALL(&m, fmi2DoStep)(m.c, STEP, -STEP, fmi2True));
    OK(step(&m, m.c, 1));
    REFUSES("holds from the start", set(&m, m.c, "arm.mass", 1));
    OK(CALL(&m, fmi2Terminate)(m.c));
    REFUSES("termination", step(&m, m.c, 2));
}

// Code of others stays outside, and so does what has no room.
TEST_IN_FOLDER(what_does_not_fit_is_refused)
{
    fmu_export *e;
    KEPT_SCENARIO(s) =
        shipped_with("corrected/first-impact", "control.law=process control.command=cat");
    REFUSED(STATUS_BAD_SCENARIO, "control.law = 'process'",
            fmu_export_create(&e, &s, NULL, &f));
    assert_null(e);
    KEPT_SCENARIO(plain) = shipped("corrected/first-impact");
    REFUSED(STATUS_BAD_ARGUMENT, "did you mean",
            fmu_export_create(&e, &plain, "motor.voltage,wall.angel", &f));
    REFUSED(STATUS_BAD_ARGUMENT, "holds from the start",
            fmu_export_create(&e, &plain, "arm.mass", &f));

    const char *file = formatted("%s/long.csv", test_folder);
    KEPT_TEXT(long_text) = malloc(400000);
    memset(long_text, '1', 399999);
    long_text[399999] = '\0';
    put_file(file, long_text);
    KEPT_SCENARIO(played) =
        shipped_with("corrected/first-impact",
                     formatted("control.law=playback control.playback_file=%s", file));
    REFUSED(STATUS_BAD_SCENARIO, "has room for",
            fmu_export_create(&e, &played, NULL, &f));
    unlink(file);
    REFUSED(STATUS_CANNOT_READ, "long.csv", fmu_export_create(&e, &played, NULL, &f));
}

int main(int argc, char **argv)
{
    if (argc == 1) {
        return run_cases(NULL, NULL);
    }

    compiler = argv[1];
    if (mkdtemp(objects) == NULL) {
        return 1;
    }
    const int failed = run_cases(NULL, NULL);
    do_shell(formatted("rm -r %s", objects));
    return failed;
}
