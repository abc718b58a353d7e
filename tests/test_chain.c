// The O(N) chain against dense matrices written from the Lagrangian.
#include "tests/arm_fixture.h"

enum { LARGEST = 12 };

// What the dense equations are written with: the numbers as they were given.
typedef struct dense_beam {
    double length[LARGEST], stiffness[LARGEST]; // of link k and of the joint before it
    double drag, stiffening;                    // of a joint
} dense_beam;

static dense_beam beam;

static double dense_mass(int k)
{
    return 0.40108 * beam.length[k] / beam.length[LARGEST - 1]; // the last holds the sum
}

static double dense_inertia(int k)
{
    return dense_mass(k) * beam.length[k] * beam.length[k] / 12;
}

static arm make_arm(int links, const char *hub, const char *wall)
{
    parameters p = parameters_with(
        "arm.links=%d arm.hub_joint=%s wall.kind=%s arm.k1=90 arm.damping_ratio=0.02",
        links, hub, wall);
    beam = (dense_beam){.length[LARGEST - 1] = 1};
    for (int k = 0; k < links; k++) {
        beam.length[k] = 1.0 / links;
        beam.stiffness[k] = k > 0 ? 4.92 * links / 2 : 90;
    }
    return arm_of(&p);
}

// Links and joints that all differ, in air; every second arm has a beam's root.
static arm make_uneven_arm(int links, const char *wall, bool rooted)
{
    const char *lengths = "arm.link_lengths=", *springs = "arm.joint_stiffness=";
    beam = (dense_beam){.drag = 0.3};
    for (int k = 0; k < links; k++) {
        beam.length[k] = 0.1 + 0.01 * ((k * 7) % 5);
        beam.length[LARGEST - 1] += beam.length[k];
        beam.stiffness[k] = 8 + (k * 5) % 7 + 0.5 * k;
        lengths = formatted("%s%s%g", lengths, k > 0 ? "," : "", beam.length[k]);
        if (k > 0 || rooted) {
            springs =
                formatted("%s%s%g", springs, k > !rooted ? "," : "", beam.stiffness[k]);
        }
    }
    parameters p = parameters_with("arm.links=%d wall.kind=%s %s %s arm.air_drag=0.3 %s",
                                   links, wall, lengths, springs,
                                   rooted ? "arm.hub_joint=beam" : "run.duration=1");
    return arm_of(&p);
}

// Equal joints that stiffen with their bend.
static arm make_stiffening_arm(int links, const char *wall)
{
    parameters p =
        parameters_with("arm.links=%d wall.kind=%s arm.stiffening=2.5", links, wall);
    beam = (dense_beam){.length[LARGEST - 1] = 1, .stiffening = 2.5 * links * links / 4};
    for (int k = 0; k < links; k++) {
        beam.length[k] = 1.0 / links;
        beam.stiffness[k] = 4.92 * links / 2;
    }
    return arm_of(&p);
}

// A bent, moving arm; different for each seed.
static void some_state(const arm *a, int seed, double *q, double *w)
{
    for (int i = 0; i < a->dof; i++) {
        q[i] = 0.1 + 0.2 * sin(3.1 * i + seed);
        w[i] = 2 * cos(2.3 * i + 0.7 * seed);
    }
}

// J by central differences of the penetration.
static void numeric_jacobian(const arm *a, double *q, const double *w, double *jacobian)
{
    for (int i = 0; i < a->dof; i++) {
        const double e = 1e-6, angle = q[i];
        q[i] = angle + e;
        const double plus = chain_penetration(a, q, w).depth;
        q[i] = angle - e;
        const double minus = chain_penetration(a, q, w).depth;
        q[i] = angle;
        jacobian[i] = (plus - minus) / (2 * e);
    }
}

// A_ij, by direct summation over the links' centres.
static double coupling(const arm *a, int i, int j)
{
    double sum = 0;
    for (int body = a->first; body < a->dof && i >= a->first && j >= a->first; body++) {
        double li = beam.length[i - a->first], lj = beam.length[j - a->first];
        double ri = body > i ? li : body == i ? li / 2 : 0;
        double rj = body > j ? lj : body == j ? lj / 2 : 0;
        sum += dense_mass(body - a->first) * ri * rj;
    }
    return sum;
}

// M_ij = A_ij cos(q_i - q_j) of the Lagrangian.
static double mass(const arm *a, const double *q, int i, int j)
{
    double sum = i == j && i >= a->first ? dense_inertia(i - a->first) : 0;
    sum += i == 0 && j == 0 ? a->hub_inertia : 0;
    return sum + coupling(a, i, j) * cos(q[i] - q[j]);
}

// dM_ij/dq_i type terms: sum_j A_ij sin(q_i - q_j) w_j^2.
static double coriolis(const arm *a, const double *q, const double *w, int i)
{
    double sum = 0;
    for (int j = a->first; j < a->dof; j++) {
        sum += coupling(a, i, j) * sin(q[i] - q[j]) * w[j] * w[j];
    }
    return sum;
}

static double spring_torque(const arm *a, const double *q, const double *w, int i)
{
    double sum = 0;
    for (int k = 1; k < a->dof; k++) {
        double s = beam.stiffness[k - a->first], bend = q[k] - q[k - 1];
        double c = k == a->first ? a->hub_joint_damping : a->joint_damping;
        double torque =
            s * (bend + beam.stiffening * bend * bend * bend) + c * (w[k] - w[k - 1]);
        sum += i == k - 1 ? torque : i == k ? -torque : 0;
    }
    return sum;
}

// Generalised force of the air, its drag summed over points of Gauss's rule along each
// link, of which two are exact.
static double drag(const arm *a, const double *q, const double *w, int i)
{
    double sum = 0;
    for (int body = i; body < a->dof && i >= a->first; body++) {
        const double length = beam.length[body - a->first];
        for (int side = -1; side <= 1; side += 2) {
            const double along = length * (0.5 + side / sqrt(12));
            double vx = 0, vy = 0;
            for (int k = a->first; k <= body; k++) {
                const double reach = k == body ? along : beam.length[k - a->first];
                vx -= reach * sin(q[k]) * w[k];
                vy += reach * cos(q[k]) * w[k];
            }
            const double reach = i == body ? along : beam.length[i - a->first];
            sum -= beam.drag * length / 2 * reach * (cos(q[i]) * vy - sin(q[i]) * vx);
        }
    }
    return sum;
}

// Residual of the Lagrangian's equations with what the chain returned.
static double largest_residual(const arm *a, double *q, const double *w,
                               const double *alpha, const chain_reaction *r)
{
    double jacobian[LARGEST] = {0}, largest = 0;
    if (wall_stands(&a->wall)) {
        numeric_jacobian(a, q, w, jacobian);
    }
    for (int i = 0; i < a->dof; i++) {
        double sum = coriolis(a, q, w, i) - spring_torque(a, q, w, i) - drag(a, q, w, i) +
                     jacobian[i] * r->force;
        for (int j = 0; j < a->dof; j++) {
            sum += mass(a, q, i, j) * alpha[j];
        }
        if (i == 0) {
            sum += a->motor.damping * w[0] - a->motor.torque - r->friction;
        }
        largest = fmax(largest, fabs(sum));
    }
    return largest;
}

// Second derivative of the penetration along the motion, by differences of its rate.
static double numeric_second_rate(const arm *a, const double *q, const double *w,
                                  const double *alpha)
{
    double rate[2], h = 1e-6;
    for (int side = 0; side < 2; side++) {
        double qs[LARGEST], ws[LARGEST], t = side ? h : -h;
        for (int i = 0; i < a->dof; i++) {
            qs[i] = q[i] + t * w[i] + t * t / 2 * alpha[i];
            ws[i] = w[i] + t * alpha[i];
        }
        rate[side] = chain_penetration(a, qs, ws).rate;
    }
    return (rate[1] - rate[0]) / (2 * h);
}

// Arms of one to ten links, on both kinds of hub and all kinds of wall, in contact and
// free, with the hub sliding either way and sticking: accelerations and reactions fulfil
// the equations of Lagrange.
TEST(satisfies_the_lagrangian)
{
    static const char *const hubs[] = {"rigid", "spring"}, *const walls[] = {"point",
                                                                             "plane",
                                                                             "none"};
    static const hub_friction frictions[] = {HUB_FORWARD, HUB_BACKWARD, HUB_STICK};
    int cases = 0;
    for (int links = 1; links <= 10; links++) {
        for (int choice = 0; choice < 2 * 3 * 3 * 2; choice++) {
            arm a = make_arm(links, hubs[choice % 2], walls[choice / 2 % 3]);
            contact_state mode = {choice / 18 == 1 && wall_stands(&a.wall),
                                  frictions[choice / 6 % 3]};
            if (a.dof == 1 && mode.contact) {
                continue; // tested below
            }

            // a state of motion, in which a hub that sticks is at rest
            double q[LARGEST], w[LARGEST], alpha[LARGEST];
            chain_link work[LARGEST];
            chain_reaction r;
            some_state(&a, choice, q, w);
            if (mode.friction == HUB_STICK) {
                w[0] = 0;
            }
            chain_accelerations(&a, work, q, w, mode, alpha, &r);
            check_below(largest_residual(&a, q, w, alpha, &r), 1e-7);

            // friction holds the hub, or is the stiction against the motion
            if (mode.friction == HUB_STICK) {
                check_close(alpha[0], 0, 0);
            } else {
                check_close(r.friction, -mode.friction * a.motor.stiction, 0);
            }

            // the acceleration of the gap by differences, and no force without contact
            if (wall_stands(&a.wall)) {
                double second = numeric_second_rate(&a, q, w, alpha);
                // differences of rates of order 10 over 2e-6 s carry rounding of order
                // 1e-9 / 1e-6
                check_close(-r.gap_acceleration, second, 1e-3 + 1e-5 * fabs(second));
            }
            assert_true(mode.contact || r.force == 0);
            cases++;
        }
    }
    assert_int_equal(cases, 10 * 36 - 6);
}

// Links and joints that differ, air, joints that stiffen: the same equations; what
// damping takes is the power of its forces.
TEST(satisfies_it_with_any_links_and_joints)
{
    static const char *const walls[] = {"point", "plane", "none"};
    static const hub_friction frictions[] = {HUB_FORWARD, HUB_STICK};
    for (int links = 2; links <= 10; links++) {
        for (int choice = 0; choice < 3 * 3 * 2 * 2; choice++) {
            const char *wall = walls[choice % 3];
            const int kind = choice / 3 % 3;
            arm a = kind < 2 ? make_uneven_arm(links, wall, kind == 1)
                             : make_stiffening_arm(links, wall);
            contact_state mode = {choice / 18 == 1 && wall_stands(&a.wall),
                                  frictions[choice / 9 % 2]};
            double q[LARGEST], w[LARGEST], alpha[LARGEST], lost = 0;
            chain_link work[LARGEST];
            chain_reaction r;
            some_state(&a, choice, q, w);
            w[0] = mode.friction == HUB_STICK ? 0 : w[0];
            chain_accelerations(&a, work, q, w, mode, alpha, &r);
            check_below(largest_residual(&a, q, w, alpha, &r), 1e-7);
            for (int i = 0; i < a.dof; i++) {
                lost -= drag(&a, q, w, i) * w[i];
            }
            check_close(r.damping_power, lost, 1e-12 * (1 + lost));
        }
    }
}

TEST(rates_follow_from_the_penetration)
{
    for (int links = 1; links <= 5; links++) {
        for (int wall = 0; wall < 2; wall++) {
            arm a = make_arm(links, "rigid", wall ? "plane" : "point");
            double q[LARGEST], w[LARGEST], jacobian[LARGEST], sum = 0;
            some_state(&a, links, q, w);
            numeric_jacobian(&a, q, w, jacobian);
            for (int i = 0; i < a.dof; i++) {
                sum += jacobian[i] * w[i];
            }
            check_close(chain_penetration(&a, q, w).rate, sum, 1e-8);
        }
    }
}

TEST(penetration_of_two_links_is_equation_3_9)
{
    arm a = make_arm(2, "spring", "point");
    double q[3], w[3], l = 0.5, x = cos(0.1), y = sin(0.1);
    some_state(&a, 4, q, w);
    check_close(chain_penetration(&a, q, w).depth,
                x * sin(q[2]) - y * cos(q[2]) - l * sin(q[2] - q[1]), 1e-15);
    // straight arm pointing at the contact point
    q[0] = q[1] = q[2] = 0.1;
    check_close(chain_penetration(&a, q, w).depth, 0, 1e-16);
}

TEST(one_link_on_a_rigid_hub_is_held_by_the_wall)
{
    arm a = make_arm(1, "rigid", "plane");
    double q[1] = {0.1}, w[1] = {0}, alpha[1];
    chain_link work[1];
    chain_reaction r;
    chain_accelerations(&a, work, q, w, (contact_state){true, HUB_STICK}, alpha, &r);
    check_close(alpha[0], 0, 1e-12);
    check_close(r.force, a.motor.torque / 1.0, 1e-12); // moment balance about the hub
    check_close(r.friction, 0, 0);
}

// w'M w / 2 of the dense mass matrix.
static void check_kinetic_energy(const arm *a, const double *q, const double *w)
{
    double kinetic = 0;
    for (int i = 0; i < a->dof; i++) {
        for (int j = 0; j < a->dof; j++) {
            kinetic += 0.5 * mass(a, q, i, j) * w[i] * w[j];
        }
    }
    check_relative(chain_kinetic_energy(a, q, w), kinetic, 1e-13);
}

TEST(energies_match_the_dense_form)
{
    for (int links = 1; links <= 6; links++) {
        arm a = make_arm(links, "spring", "none");
        double q[LARGEST], w[LARGEST], strain = 0;
        some_state(&a, links, q, w);
        for (int k = 1; k < a.dof; k++) {
            double stiffness = k == 1 ? 90 : 4.92 * links / 2.0;
            strain += 0.5 * stiffness * (q[k] - q[k - 1]) * (q[k] - q[k - 1]);
        }
        check_kinetic_energy(&a, q, w);
        check_relative(chain_strain_energy(&a, q), strain, 1e-13);
    }
}

// The same of links and joints that differ, and of joints whose torque is the energy's
// slope.
TEST(energies_match_with_any_links_and_joints)
{
    for (int links = 2; links <= 6; links++) {
        arm a = make_uneven_arm(links, "none", links % 2);
        double q[LARGEST], w[LARGEST];
        some_state(&a, links, q, w);
        check_kinetic_energy(&a, q, w);
        for (int kind = 0; kind < 2; kind++) {
            const double step = 1e-5, angle = q[links - 1];
            double energy[2];
            a = kind == 0 ? a : make_stiffening_arm(links, "none");
            for (int side = 0; side < 2; side++) {
                q[links - 1] = angle + (side ? step : -step);
                energy[side] = chain_strain_energy(&a, q);
            }
            q[links - 1] = angle;
            double still[LARGEST] = {0};
            check_close((energy[1] - energy[0]) / (2 * step),
                        -spring_torque(&a, q, still, links - 1), 1e-7);
        }
    }
}

// A joint that stiffens vibrates as much faster as half as much again of its own
// stiffness, which is 1 + 3 s b^2 at the bend b of the joint that is bent most; a root
// stands for twice its bend.
TEST(bends_make_it_vibrate_faster)
{
    arm a = make_stiffening_arm(4, "none"), even = make_arm(4, "rigid", "none");
    const double q[4] = {0.3, 0.35, 0.15, 0.25}, s = 2.5 * 4 * 4 / 4;
    check_relative(chain_stiffened(&a, q), sqrt(1 + 1.5 * 3 * s * 0.2 * 0.2), 1e-14);
    check_close(chain_stiffened(&even, q), 1, 0);
    a.first = 1;
    a.hub_spring = true;
    a.links = 3;
    const double root[4] = {0.3, 0.15, 0.35, 0.25};
    check_relative(chain_stiffened(&a, root), sqrt(1 + 1.5 * 3 * s * 0.3 * 0.3), 1e-14);
}

// m v^2 / 2 of the tip, whose velocity is the sum over the links.
TEST(a_mass_at_the_tip_adds_its_own_energy)
{
    for (int links = 1; links <= 6; links++) {
        arm a = make_arm(links, "spring", "none");
        double q[LARGEST], w[LARGEST], vx = 0, vy = 0;
        some_state(&a, links, q, w);
        const double before = chain_kinetic_energy(&a, q, w);
        for (int k = a.first; k < a.dof; k++) {
            vx -= sin(q[k]) * w[k] / links;
            vy += cos(q[k]) * w[k] / links;
        }
        a.tip_mass = 0.3;
        check_relative(chain_kinetic_energy(&a, q, w),
                       before + 0.15 * (vx * vx + vy * vy), 1e-13);
    }
}

// Folded over the hub's axis the tip stands on a flat wall that cannot move it: no link's
// velocity changes the penetration. A point, or an arm that cannot fold, is no such wall.
TEST(an_arm_is_folded_where_a_flat_wall_moves_no_link)
{
    for (int links = 2; links <= 6; links += 2) {
        arm flat = make_arm(links, "spring", "plane"),
            point = make_arm(links, "spring", "point");
        double q[LARGEST], jacobian[LARGEST], largest = 0;
        q[0] = 0.7; // a hub behind a spring may stand anywhere
        for (int k = flat.first; k < flat.dof; k++) {
            q[k] = 0.1 + (k % 2 ? M_PI / 2 : -M_PI / 2);
        }
        numeric_jacobian(&flat, q, q, jacobian);
        for (int i = 0; i < flat.dof; i++) {
            largest = fmax(largest, fabs(jacobian[i]));
        }
        check_below(largest, 1e-9);
        assert_true(chain_is_folded(&flat, q));
        assert_false(chain_is_folded(&point, q));

        // one link that leans lets the wall turn it
        q[flat.dof - 1] += 0.1;
        numeric_jacobian(&flat, q, q, jacobian);
        assert_true(fabs(jacobian[flat.dof - 1]) > 1e-3);
        assert_false(chain_is_folded(&flat, q));
    }

    // without a wall there is no penetration
    arm alone = make_arm(2, "rigid", "none");
    const double q[2] = {3, 3}, w[2] = {1, 1};
    const penetration none = chain_penetration(&alone, q, w);
    assert_true(none.depth == -HUGE_VAL && none.rate == 0);

    // a rod across the wall stands away from it
    arm rod = make_arm(1, "rigid", "plane");
    assert_false(chain_is_folded(&rod, (double[]){0.1 + M_PI / 2}));
}

// Nodes lie a link apart from one another, each in the direction of its link; and the
// strain is the work that it takes to bend the joints.
TEST(nodes_follow_the_links)
{
    for (int kind = 0; kind < 3; kind++) {
        for (int links = 1 + (kind == 1); links <= 8; links++) {
            arm a = kind == 1 ? make_uneven_arm(links, "point", links % 2)
                              : make_arm(links, kind ? "spring" : "rigid", "plane");
            double q[LARGEST], w[LARGEST], x = 0, y = 0, before_x, before_y;
            some_state(&a, links, q, w);
            chain_node(&a, q, 0, &x, &y);
            check_close(fabs(x) + fabs(y), 0, 0);
            for (int k = 0; k < links; k++) {
                before_x = x, before_y = y;
                chain_node(&a, q, k + 1, &x, &y);
                check_close(x - before_x, beam.length[k] * cos(q[a.first + k]), 1e-15);
                check_close(y - before_y, beam.length[k] * sin(q[a.first + k]), 1e-15);
            }

            // a push on the tip turns it the way that it pushes, by the force over the
            // compliance
            double response[LARGEST], moved[LARGEST], ahead_x, ahead_y;
            chain_link work[LARGEST];
            chain_tip_response(&a, work, q, response);
            const int last = a.dof - 1;
            for (int k = 0; k < a.dof; k++) {
                moved[k] = q[k] + 1e-6 * response[k];
            }
            chain_node(&a, moved, links, &ahead_x, &ahead_y);
            const double across =
                -(ahead_x - x) * sin(q[last]) + (ahead_y - y) * cos(q[last]);

            // what the push gives in energy is half its way
            check_relative(across * 1e6 / 2, chain_kinetic_energy(&a, q, response), 1e-4);
        }
    }
}

// A list may be one digit long: it is that arm's only joint or link.
TEST(a_list_of_one_digit_is_one)
{
    const double q[2] = {0.3, 0.7};
    arm listed, plain;
    parameters p = parameters_with("arm.links=2 arm.joint_stiffness=8");
    arm_init(&listed, &p);
    p = parameters_with("arm.links=2 arm.k2=8");
    arm_init(&plain, &p);
    check_relative(chain_strain_energy(&listed, q), 0.5 * 8 * 0.4 * 0.4, 1e-14);
    check_relative(listed.highest_frequency, plain.highest_frequency, 1e-9);

    double x, y;
    p = parameters_with("arm.links=1 arm.link_lengths=2");
    arm_init(&listed, &p);
    chain_node(&listed, q, 1, &x, &y);
    check_close(x, 2 * cos(q[0]), 1e-14);
    check_close(y, 2 * sin(q[0]), 1e-14);
}
