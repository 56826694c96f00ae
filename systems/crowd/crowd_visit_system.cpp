#include "systems/crowd/crowd_visit_system.h"

#include "ecs/base/hash.h"
#include "ecs/base/rng.h"
#include "systems/animation/ik/placements.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

// Techniques: char.crowd-script

namespace limn {
namespace {

constexpr float kStuckSpeed = 0.25f;  // slower is not getting farther [m/s]
constexpr float kStayNear = 0.6f;     // of where it arrived [m]

struct VisitedPlace {
    Entity entity{};
    Vec3 center{};
    float radius = 0.0f;
    float stay = 0.0f;
    float appeal = 0.0f;  ///< of this and all before it
};

std::vector<VisitedPlace>
list_places(const Query<const CrowdPlace, const CrowdExit>& places, const Placements& placements) {
    std::vector<VisitedPlace> list;
    places.each([&](Entity entity, const CrowdPlace& place, const CrowdExit& exit) {
        const Affine world = placements.world(entity);
        const Vec3 center = {world.row[0].w, world.row[1].w, world.row[2].w};
        if (is_finite(center) && exit.radius > 0 && place.appeal > 0
            && std::isfinite(place.appeal + place.stay + exit.radius)) {
            list.push_back({entity, center, exit.radius, place.stay, place.appeal});
        }
    });
    std::sort(list.begin(), list.end(), [](const VisitedPlace& a, const VisitedPlace& b) {
        return a.entity.bits() < b.entity.bits();
    });
    float sum = 0;
    for (VisitedPlace& place : list) {
        sum += place.appeal;
        place.appeal = sum;
    }
    return list;
}

const VisitedPlace* find_place_of(const std::vector<VisitedPlace>& places, Entity entity) {
    const auto found =
        std::find_if(places.begin(), places.end(), [entity](const VisitedPlace& place) {
            return place.entity == entity;
        });
    return found != places.end() ? &*found : nullptr;
}

/// One of the places by its appeal; where it is already counts as the next one.
const VisitedPlace&
choose_place(const std::vector<VisitedPlace>& places, Entity here, float random) {
    const float mark = random * places.back().appeal;
    const auto found =
        std::find_if(places.begin(), places.end() - 1, [mark](const VisitedPlace& place) {
            return mark < place.appeal;
        });
    if (found->entity != here) {
        return *found;
    }
    return found + 1 != places.end() ? *(found + 1) : places.front();
}

Vec3 level(const Vec3& v) {
    return {v.x, 0, v.z};
}

}  // namespace

void add_crowd_visits(Query<const CrowdVisitor, Without<CrowdVisit>> bare, Commands commands) {
    bare.each([&](Entity entity, const CrowdVisitor&) { commands.add(entity, CrowdVisit{}); });
}

void update_crowd_visits(
    Query<const CrowdVisitor, CrowdVisit, const CrowdState, CrowdGoal, MoveIntent, const Transform>
        visitors,
    Query<const CrowdPlace, const CrowdExit> places, Query<const Transform> transforms,
    Query<const Parent> parents, Res<const RandomSeed> seed, Res<const FrameTime> time) {
    if (visitors.empty() || places.empty()) {
        return;
    }
    const std::vector<VisitedPlace> list = list_places(places, Placements(transforms, parents));
    if (list.empty()) {
        return;
    }
    visitors.par_each([&](Entity entity, const CrowdVisitor& visitor, CrowdVisit& visit,
                          const CrowdState& state, CrowdGoal& goal, MoveIntent& intent,
                          const Transform& transform) {
        const VisitedPlace* const place = find_place_of(list, visit.place);
        Random random(seed->seed, entity.bits(), name_hash("update_crowd_visits"), time->frame);
        if (place != nullptr && visit.arrived != 0) {
            visit.left -= time->step;
            intent.facing = level(place->center - transform.position);
        }
        if (place == nullptr || (visit.arrived != 0 && !(visit.left > 0))) {
            visit.place = choose_place(list, visit.place, random.uniform()).entity;
            visit.arrived = 0;
            goal.exit = visit.place;
            intent.facing = Vec3(0);
            return;
        }
        if (visit.arrived != 0) {
            return;
        }
        const float distance = glm::length(level(place->center - transform.position));
        const bool stuck = glm::length(state.velocity) < kStuckSpeed;
        if (distance < place->radius || (stuck && distance < 2 * place->radius)) {
            visit.arrived = 1;
            visit.left =
                std::max(place->stay * visitor.patience, 0.0f) * random.uniform(0.5f, 1.5f);
            goal.exit = {};
            goal.point = transform.position;
            goal.arrive = kStayNear;
        }
    });
}

void place_stand_ins(
    Query<const CrowdStandIn, CrowdState, MoveIntent, Transform, Without<CharacterMotor>> stand_ins,
    Query<const Transform, const MotorState> characters) {
    stand_ins.each([&](const CrowdStandIn& stand_in, CrowdState& state, MoveIntent& intent,
                       Transform& transform) {
        const Transform* const place = characters.find<const Transform>(stand_in.character);
        const MotorState* const motor = characters.find<const MotorState>(stand_in.character);
        if (place == nullptr || motor == nullptr) {
            return;
        }
        transform.position = place->position;
        state.velocity = {motor->velocity.x, motor->velocity.z};
        intent.velocity = motor->velocity;
    });
}

}  // namespace limn
