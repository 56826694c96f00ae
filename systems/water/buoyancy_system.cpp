#include "systems/water/buoyancy_system.h"

#include "ecs/base/jobs.h"
#include "systems/water/floating_body.h"
#include "systems/water/floating_contact.h"

#include <optional>
#include <vector>

namespace limn {

namespace {

constexpr std::size_t kBodyGrain = 4;  ///< bodies per task

struct Body {
    const WaterTouch* touch = nullptr;
    const Floating* floating = nullptr;
    FloatingState* state = nullptr;
    Transform* transform = nullptr;
    std::optional<Splash> splash{};
};

}  // namespace

void add_floating_states(Query<const Floating, Without<FloatingState>> bodies, Commands commands) {
    bodies.each([&](Entity entity, const Floating& floating) {
        commands.add(entity, FloatingState{.velocity = floating.velocity, .spin = floating.spin});
    });
}

void update_floating_bodies(
    WaterQuery waters, Query<RippleState> ripples,
    Query<const WaterTouch, const Floating, FloatingState, Transform, Without<Parent>> bodies,
    Res<const FrameTime> time) {
    thread_local std::vector<Body> body_memory;  // reused between steps
    std::vector<Body>& afloat = body_memory;
    afloat.clear();
    bodies.each([&](const WaterTouch& touch, const Floating& floating, FloatingState& state,
                    Transform& transform) {
        afloat.push_back({&touch, &floating, &state, &transform});
    });
    if (afloat.empty()) {
        return;
    }
    const std::vector<WaterSurface> surfaces = collect_water_surfaces(waters);
    parallel_for(afloat.size(), kBodyGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Body& body = afloat[i];
            body.splash = step_floating_body(
                surfaces, *body.touch, *body.floating, time->step, *body.state, *body.transform);
        }
    });
    thread_local std::vector<ContactBody> contact_memory;  // reused between steps
    contact_memory.clear();
    for (const Body& body : afloat) {
        contact_memory.push_back({body.touch, body.floating, body.state, body.transform});
    }
    if (time->step > 0) {
        separate_floating_bodies(contact_memory);
    }
    for (const Body& body : afloat) {  // in their order, for determinism
        if (!body.splash) {
            continue;
        }
        if (auto* const hit = ripples.find<RippleState>(surfaces[body.splash->surface].entity)) {
            hit->impulses.push_back(body.splash->impulse);
        }
    }
}

}  // namespace limn
