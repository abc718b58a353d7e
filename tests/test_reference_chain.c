// Chains of many links against the independent simulation (tests/reference): with both
// hub roots, with and without structural damping, on both walls, with plastic impacts and
// with bounces; by the engine that a run takes, and of few links by the explicit formula
// too.
//
//   test_reference_chain [--from FOLDER | --into FOLDER] [LINKS[:KIND]...]     default:
//   8, all kinds
//
// KIND is the sum of 1 (beam root, else rigid), 2 (plane wall, else point), 4 (e = 0.5,
// else 0) and 8 (1 % damping, else none). --into keeps the simulation's answers in
// FOLDER, --from compares with those kept there: 64 links take it many minutes a case.

#include "tests/arm_fixture.h"
#include "tests/chain_outcome.h"
#include "tests/explicit_stepper.h"

#define START_ANGLE    0.095 // a little in front of the wall at 0.1 rad
#define START_VELOCITY 0.7   // [rad/s]
#define DURATION       0.06
#define FEW_LINKS      16 // of which that formula has the time

static chain_outcome library_outcome(const reference_case *c, bool by_formula)
{
    parameters p =
        parameters_with("arm.links=%d arm.damping_ratio=%.17g wall.restitution=%.17g %s "
                        "%s motor.voltage=1",
                        c->links, c->damping, c->restitution,
                        c->beam_root ? "arm.hub_joint=beam" : "arm.hub_joint=rigid",
                        c->plane_wall ? "wall.kind=plane" : "wall.kind=point");

    const chain_start start = {&p,          c->angle,
                               c->velocity, c->duration,
                               c->duration, by_formula ? &explicit_engine : NULL};
    chain_outcome o = chain_outcome_of(&start);
    fail_if(o.status != STATUS_OK, "%s, %s: %s", c->name,
            by_formula ? "formula" : "default", status_text(o.status));
    return o;
}

static chain_outcome reference_outcome(const reference_case *c)
{
    static reference_answer r;
    char message[256];
    fail_if(!reference_simulate(c, &r, message, sizeof message),
            "the reference failed: %s", message);
    chain_outcome o = {.first_contact = r.first_contact,
                       .first_impulse = r.first_impulse,
                       .motor_work = r.motor_work,
                       .residual = r.energy_residual,
                       .impacts = r.impacts,
                       .samples = r.samples};
    memcpy(o.momentum, r.momentum, sizeof o.momentum);
    return o;
}

// --- answers that are kept -------------------------------------------------------------

static const char *from, *into; // folders of kept answers; NULL: none
static char said[200];          // of the case: kept answers are of no other one

// What the answer is of, and the file that keeps it.
static void describe(const reference_case *c, const char *folder, char path[static 512])
{
    snprintf(path, 512, "%s/%d-%d.csv", folder, c->links,
             c->beam_root + 2 * c->plane_wall + 4 * (c->restitution > 0) +
                 8 * (c->damping > 0));
    snprintf(said, sizeof said,
             "%s, from %g rad and %g rad/s at %g V for %g s, tolerance %g, "
             "looks %g s apart",
             c->name, c->angle, c->velocity, c->voltage, c->duration, c->tolerance,
             c->longest_step);
}

static void keep(const reference_case *c, const chain_outcome *o)
{
    char path[512];
    describe(c, into, path);
    FILE *file = fopen(path, "w");
    fail_if(file == NULL, "%s: %s", path, strerror(errno));
    fprintf(file, "# %s\n%.15g,%.15g,%.15g,%.15g,%d,%d\n", said, o->first_contact,
            o->first_impulse, o->motor_work, o->residual, o->impacts, o->samples);
    for (int k = 0; k < o->samples; k++) {
        fprintf(file, "%.15g\n", o->momentum[k]);
    }
    assert_int_equal(fclose(file), 0);
}

static chain_outcome kept(const reference_case *c)
{
    char path[512], head[256] = "";
    describe(c, from, path);
    FILE *file = fopen(path, "r");
    fail_if(file == NULL, "%s: %s", path, strerror(errno));

    // of this case
    assert_non_null(fgets(head, sizeof head, file));
    head[strcspn(head, "\n")] = '\0';
    assert_int_equal(strncmp(head, "# ", 2), 0);
    assert_string_equal(head + 2, said);

    // its numbers
    chain_outcome o = {0};
    int read = fscanf(file, "%lf,%lf,%lf,%lf,%d,%d", &o.first_contact, &o.first_impulse,
                      &o.motor_work, &o.residual, &o.impacts, &o.samples);
    assert_true(read == 6 && o.samples >= 0 && o.samples <= REFERENCE_SAMPLES);
    for (int k = 0; k < o.samples; k++) {
        assert_int_equal(fscanf(file, "%lf", &o.momentum[k]), 1);
    }
    fclose(file);
    return o;
}

// --- comparing -------------------------------------------------------------------------

static bool within(const char *what, double difference, double bound)
{
    bool close = fabs(difference) <= bound;
    printf(" %s %.2g%s", what, difference, close ? "" : " <-- too far");
    return close;
}

static bool compare(const reference_case *c, const chain_outcome *r, bool by_formula)
{
    chain_outcome l = library_outcome(c, by_formula);
    const int last = REFERENCE_SAMPLES - 1;
    printf("    %s:", by_formula ? "formula" : "default");
    bool same = within("contact", l.first_contact - r->first_contact, 1e-6);
    same &= within("impulse", l.first_impulse / r->first_impulse - 1, 1e-4);
    same &=
        within("1 ms", l.momentum[OUTCOME_FIRST_MS] / r->momentum[OUTCOME_FIRST_MS] - 1,
               1e-3);
    same &= within("50 ms", l.momentum[last] / r->momentum[last] - 1, 1e-3);
    same &= within("sensor", chain_outcome_sensor_difference(r, &l), 5e-3);
    same &= within("work", l.motor_work / r->motor_work - 1, 1e-4);
    same &= within("residual", l.residual / l.put_in, 1e-6);
    same &= within("impacts", l.impacts - r->impacts,
                   c->links <= 16 ? 0 : 0.1 * r->impacts + 2);
    printf("\n");
    return same;
}

static void library_agrees(void **state)
{
    const reference_case *c = *state;
    chain_outcome r = from != NULL ? kept(c) : reference_outcome(c);
    if (into != NULL) {
        keep(c, &r);
    }
    printf("%s: contact %.9g s, impulse %.9g N s, %d impacts, after 50 ms %.9g "
           "N s, reference's residual %.2g J\n",
           c->name, r.first_contact, r.first_impulse, r.impacts,
           r.momentum[REFERENCE_SAMPLES - 1], r.residual);
    assert_int_equal(r.samples, REFERENCE_SAMPLES);
    bool same = compare(c, &r, false);
    same &= c->links > FEW_LINKS || compare(c, &r, true);
    fflush(stdout);
    assert_true(same);
}

int main(int argc, char **argv)
{
    enum { KINDS = 16, MOST = 16 };
    static reference_case cases[MOST * KINDS];
    static char names[MOST * KINDS][80];
    static struct CMUnitTest tests[MOST * KINDS];
    if (argc > 2 && (strcmp(argv[1], "--from") == 0 || strcmp(argv[1], "--into") == 0)) {
        *(argv[1][2] == 'f' ? &from : &into) = argv[2];
        argc -= 2;
        argv += 2;
    }
    const char *defaults[] = {"", "8"};
    char **given = argc > 1 ? argv : (char **)defaults;
    int numbers = argc > 1 ? argc - 1 : 1, count = 0;
    for (int i = 1; i <= numbers && i <= MOST; i++) {
        const char *colon = strchr(given[i], ':');
        const int links = atoi(given[i]), only = colon != NULL ? atoi(colon + 1) : -1;
        for (int kind = 0; kind < KINDS; kind++) {
            if (only >= 0 && kind != only) {
                continue;
            }
            bool beam = kind & 1, plane = kind & 2, bounces = kind & 4, damped = kind & 8;
            snprintf(names[count], sizeof names[count],
                     "N = %d, %s root, %s, e = %g, %g %%", links, beam ? "beam" : "rigid",
                     plane ? "plane" : "point", bounces ? 0.5 : 0, damped ? 1.0 : 0.0);
            // looks within a third of the fastest period
            cases[count] = (reference_case){.name = names[count],
                                            .links = links,
                                            .beam_root = beam,
                                            .plane_wall = plane,
                                            .voltage = 1,
                                            .restitution = bounces ? 0.5 : 0,
                                            .duration = DURATION,
                                            .tolerance = 1e-11,
                                            .longest_step = 1e-4 * 64 / links / links,
                                            .damping = damped ? 0.01 : 0,
                                            .angle = START_ANGLE,
                                            .velocity = START_VELOCITY};
            tests[count] = (struct CMUnitTest){names[count], library_agrees, NULL, NULL,
                                               &cases[count]};
            count++;
        }
    }
    return _cmocka_run_group_tests("chains", tests, (size_t)count, NULL, NULL) != 0;
}
