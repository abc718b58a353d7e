// DART: rigid contact by impulses from a linear complementarity problem in every step; springs and
// damping of the joints are implicit. A tiny sphere at the tip meets a box, the flat wall.
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>

#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/DegreeOfFreedom.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include "tests/bench/peers/peer.h"

namespace
{

const double radius = 1e-3; // of the sphere at the tip [m]

struct arm_world {
    std::shared_ptr<dart::simulation::World> world;
    dart::dynamics::SkeletonPtr arm;
    dart::dynamics::BodyNode *tip;
};

// Hub inertia is added to the first link's: it turns about the fixed axis only.
dart::dynamics::BodyNode *add_link(const dart::dynamics::SkeletonPtr &arm,
                                   dart::dynamics::BodyNode *before, double hub_inertia)
{
    const double l = EXPERIMENT_BEAM_LENGTH / 2, m = EXPERIMENT_BEAM_MASS / 2;
    const double inertia = m * l * l / 12;
    dart::dynamics::RevoluteJoint::Properties joint;
    joint.mName = before != nullptr ? "middle" : "hub"; // equal names would be complained about
    joint.mAxis = Eigen::Vector3d::UnitZ();
    if (before != nullptr) {
        joint.mT_ParentBodyToJoint.translation() = Eigen::Vector3d(l, 0, 0);
    }
    dart::dynamics::BodyNode::Properties body;
    body.mName = before != nullptr ? "second" : "first";
    body.mInertia.setMass(m);
    body.mInertia.setLocalCOM(Eigen::Vector3d(l / 2, 0, 0));
    body.mInertia.setMoment(inertia / 100, inertia, inertia + hub_inertia, 0, 0, 0);
    return arm->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(before, joint, body)
        .second;
}

dart::dynamics::SkeletonPtr make_arm(arm_world *a)
{
    const double l = EXPERIMENT_BEAM_LENGTH / 2;
    dart::dynamics::SkeletonPtr arm = dart::dynamics::Skeleton::create("arm");
    dart::dynamics::BodyNode *first = add_link(arm, nullptr, EXPERIMENT_HUB_INERTIA);
    a->tip = add_link(arm, first, 0);
    auto shape = std::make_shared<dart::dynamics::SphereShape>(radius);
    auto *node = a->tip->createShapeNodeWith<dart::dynamics::CollisionAspect,
                                             dart::dynamics::DynamicsAspect>(shape);
    node->setRelativeTranslation(Eigen::Vector3d(l, 0, 0));
    node->getDynamicsAspect()->setFrictionCoeff(0);
    node->getDynamicsAspect()->setRestitutionCoeff(0);
    arm->getDof(0)->setDampingCoefficient(EXPERIMENT_HUB_DAMPING);
    arm->getDof(0)->setCoulombFriction(EXPERIMENT_STICTION);
    arm->getDof(1)->setSpringStiffness(EXPERIMENT_SPRING);
    return arm;
}

// A thick box whose face, moved by the sphere's radius, is the wall.
dart::dynamics::SkeletonPtr make_wall()
{
    const double thickness = 0.5;
    dart::dynamics::SkeletonPtr wall = dart::dynamics::Skeleton::create("wall");
    auto *body = wall->createJointAndBodyNodePair<dart::dynamics::WeldJoint>().second;
    auto shape = std::make_shared<dart::dynamics::BoxShape>(Eigen::Vector3d(4, thickness, 1));
    auto *node =
        body->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(
            shape);
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.rotate(Eigen::AngleAxisd(EXPERIMENT_WALL, Eigen::Vector3d::UnitZ()));
    place.translate(Eigen::Vector3d(0, radius + thickness / 2, 0));
    node->setRelativeTransform(place);
    node->getDynamicsAspect()->setFrictionCoeff(0);
    node->getDynamicsAspect()->setRestitutionCoeff(0);
    return wall;
}

void *create(const peer *)
{
    try {
        auto a = std::unique_ptr<arm_world>(new arm_world());
        a->world = dart::simulation::World::create("experiment");
        a->world->setGravity(Eigen::Vector3d::Zero());
        a->world->setTimeStep(EXPERIMENT_STEP);
        a->world->getConstraintSolver()->setCollisionDetector(
            dart::collision::DARTCollisionDetector::create());
        a->arm = make_arm(a.get());
        a->world->addSkeleton(a->arm);
        a->world->addSkeleton(make_wall());
        return a.release();
    } catch (const std::exception &e) {
        std::fprintf(stderr, "peers: DART: %s\n", e.what());
        return nullptr;
    }
}

void destroy(void *instance)
{
    delete static_cast<arm_world *>(instance);
}

bool run(void *instance, peer_answer *answer)
{
    arm_world *a = static_cast<arm_world *>(instance);
    contact_watch watch;
    contact_watch_begin(&watch, EXPERIMENT_STEP, answer);
    a->world->reset();
    a->arm->resetPositions();
    a->arm->resetVelocities();
    const long steps = std::lround(EXPERIMENT_DURATION / EXPERIMENT_STEP);
    for (long i = 0; i < steps; i++) {
        double time = a->world->getTime();
        double angles = 2 * a->arm->getPosition(0) + a->arm->getPosition(1);
        double rate = 2 * a->arm->getVelocity(0) + a->arm->getVelocity(1);
        a->arm->setForce(0, EXPERIMENT_TORQUE * EXPERIMENT_VOLTAGE);
        a->world->step();
        double force = 0;
        for (const auto &contact : a->world->getLastCollisionResult().getContacts()) {
            force += contact.force.norm();
        }
        contact_watch_sample(&watch, time, angles, rate, force);
    }
    answer->hub_angle = a->arm->getPosition(0);
    answer->steps = static_cast<double>(steps);
    return std::isfinite(answer->hub_angle);
}

double fixed_step(const void *)
{
    return EXPERIMENT_STEP;
}

const peer list_of_peers[] = {
    {"DART", DART_VERSION, "sphere and box, Dantzig", 2, 0, create, destroy, run, fixed_step,
     peer_duration},
};

} // namespace

extern "C" int peers_dart(const peer **list)
{
    *list = list_of_peers;
    return static_cast<int>(sizeof list_of_peers / sizeof list_of_peers[0]);
}
