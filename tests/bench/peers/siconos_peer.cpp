// Siconos: a nonsmooth reference. The wall's impulse and the hub's set-valued friction come from
// one complementarity problem in every step (Moreau and Jean's scheme, theta = 1/2), with impacts
// by Newton's law and no event located.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>

#include <SiconosKernel.hpp>

#include "tests/bench/peers/peer.h"

namespace
{

const double link_length = EXPERIMENT_BEAM_LENGTH / 2, link_mass = EXPERIMENT_BEAM_MASS / 2;
const double coupling = link_mass * link_length * link_length / 2;

// Mass of the links' angles; what a torque of velocities, spring and motor is against it.
void mass_of(unsigned, double *q, double *mass, unsigned, double *)
{
    const double own = link_mass * link_length * link_length;
    mass[0] = EXPERIMENT_HUB_INERTIA + own / 12 + 1.25 * own;
    mass[1] = mass[2] = coupling * std::cos(q[1] - q[0]);
    mass[3] = own / 12 + 0.25 * own;
}

void gyroscopic_of(unsigned, double *q, double *v, double *out, unsigned, double *)
{
    const double b = coupling * std::sin(q[1] - q[0]);
    out[0] = -b * v[1] * v[1];
    out[1] = b * v[0] * v[0];
}

void internal_of(double, unsigned, double *q, double *v, double *out, unsigned, double *)
{
    const double bent = EXPERIMENT_SPRING * (q[1] - q[0]);
    out[0] = EXPERIMENT_HUB_DAMPING * v[0] - EXPERIMENT_TORQUE * EXPERIMENT_VOLTAGE - bent;
    out[1] = bent;
}

void stiffness_of(double, unsigned, double *, double *, double *out, unsigned, double *)
{
    out[0] = out[3] = EXPERIMENT_SPRING;
    out[1] = out[2] = -EXPERIMENT_SPRING;
}

void damping_of(double, unsigned, double *, double *, double *out, unsigned, double *)
{
    out[0] = EXPERIMENT_HUB_DAMPING;
    out[1] = out[2] = out[3] = 0;
}

// The gap of the tip to the flat wall.
class wall_gap : public LagrangianScleronomousR
{
  public:
    void computeh(const BlockVector &q, BlockVector &, SiconosVector &y) override
    {
        y.setValue(0, -link_length * (std::sin(q.getValue(0) - EXPERIMENT_WALL) +
                                      std::sin(q.getValue(1) - EXPERIMENT_WALL)));
    }
    void computeJachq(const BlockVector &q, BlockVector &) override
    {
        for (unsigned k = 0; k < 2; k++) {
            _jachq->setValue(0, k, -link_length * std::cos(q.getValue(k) - EXPERIMENT_WALL));
        }
    }
    void initialize(Interaction &inter) override
    {
        _jachq = std::make_shared<SimpleMatrix>(1, 2);
        LagrangianScleronomousR::initialize(inter);
    }
};

struct world {
    SP::LagrangianDS arm;
    SP::Interaction wall;
    SP::TimeStepping steps;
};

world make_world(double step)
{
    world w;
    auto rest = std::make_shared<SiconosVector>(2), still = std::make_shared<SiconosVector>(2);
    w.arm = std::make_shared<LagrangianDS>(rest, still);
    w.arm->setComputeMassFunction(mass_of);
    w.arm->setComputeFGyrFunction(gyroscopic_of);
    w.arm->setComputeFIntFunction(internal_of);
    w.arm->setComputeJacobianFIntqFunction(stiffness_of);
    w.arm->setComputeJacobianFIntqDotFunction(damping_of);

    // plastic impacts; friction of the hub, whose "gap" is closed for ever
    w.wall = std::make_shared<Interaction>(std::make_shared<NewtonImpactNSL>(0),
                                           std::make_shared<wall_gap>());
    auto of_hub = std::make_shared<SimpleMatrix>(1, 2);
    of_hub->setValue(0, 0, 1);
    auto closed = std::make_shared<SiconosVector>(1);
    closed->setValue(0, -1e3);
    const double most = EXPERIMENT_STICTION * step;
    auto hub = std::make_shared<Interaction>(std::make_shared<RelayNSL>(1, -most, most),
                                             std::make_shared<LagrangianLinearTIR>(of_hub, closed));

    auto model = std::make_shared<NonSmoothDynamicalSystem>(0, EXPERIMENT_DURATION);
    model->insertDynamicalSystem(w.arm);
    model->link(w.wall, w.arm);
    model->link(hub, w.arm);
    w.steps = std::make_shared<TimeStepping>(model, std::make_shared<TimeDiscretisation>(0, step),
                                             std::make_shared<MoreauJeanOSI>(0.5),
                                             std::make_shared<GenericMechanical>());
    w.steps->setNewtonTolerance(1e-10);
    w.steps->setNewtonMaxIteration(20);
    return w;
}

struct instance {
    double step;
};

void *create(const peer *self)
{
    return new instance{EXPERIMENT_STEP / self->variant};
}

void destroy(void *of)
{
    delete static_cast<instance *>(of);
}

// The model is made anew for every run; only its steps are timed.
bool run(void *of, peer_answer *answer)
{
    const double step = static_cast<instance *>(of)->step;
    try {
        world w = make_world(step);
        contact_watch watch;
        contact_watch_begin(&watch, step, answer);
        const std::clock_t start = std::clock();
        const long steps = std::lround(EXPERIMENT_DURATION / step);
        for (long i = 0; i < steps; i++) {
            const SiconosVector &q = *w.arm->q(), &v = *w.arm->velocity();
            const double time = static_cast<double>(i) * step;
            const double angles = q(0) + q(1), rate = v(0) + v(1);
            w.steps->computeOneStep();
            const double force = (*w.wall->lambda(1))(0) / step;
            contact_watch_sample(&watch, time, angles, rate, force);
            w.steps->nextStep();
        }
        answer->computing_time = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        answer->hub_angle = (*w.arm->q())(0);
        answer->steps = static_cast<double>(steps);
        return std::isfinite(answer->hub_angle);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "peers: Siconos: %s\n", e.what());
    } catch (...) {
        std::fprintf(stderr, "peers: Siconos: the run failed\n");
    }
    return false;
}

double fixed_step(const void *of)
{
    return static_cast<const instance *>(of)->step;
}

const peer list_of_peers[] = {
    {"Siconos", SICONOS_VERSION, "Moreau-Jean", 2, 1, create, destroy, run, fixed_step,
     peer_duration},
    {"Siconos", SICONOS_VERSION, "Moreau-Jean, a tenth of the step", 2, 10, create, destroy, run,
     fixed_step, peer_duration},
    {"Siconos", SICONOS_VERSION, "Moreau-Jean, a hundredth", 2, 100, create, destroy, run,
     fixed_step, peer_duration},
};

} // namespace

extern "C" int peers_siconos(const peer **list)
{
    *list = list_of_peers;
    return static_cast<int>(sizeof list_of_peers / sizeof list_of_peers[0]);
}
