#include "systems/water/buoyancy_system.h"

#include "ecs/base/jobs.h"
#include "systems/water/floating_body.h"
#include "systems/water/water_query.h"

#include <optional>
#include <vector>

namespace limn {

namespace {

constexpr std::size_t kGrain = 4;  ///< bodies a task

struct Body {
    const WaterTouch* touch = nullptr;
    Floating* floating = nullptr;
    Transform* transform = nullptr;
    std::optional<Splash> splash{};
};

}  // namespace

void update_floating_bodies(
    Query<
        const Water, const WorldTransform, Optional<const OceanState>, Optional<const WaveTable>,
        Optional<RippleState>>
        waters,
    Query<const WaterTouch, Floating, Transform, Without<Parent>> bodies,
    Res<const FrameTime> time) {
    thread_local std::vector<WaterSurface> surface_memory;  // kept from step to step
    thread_local std::vector<Body> body_memory;
    std::vector<RippleState*> ripples;
    std::vector<WaterSurface>& surfaces = surface_memory;
    std::vector<Body>& afloat = body_memory;
    surfaces.clear();
    afloat.clear();
    bodies.each([&](const WaterTouch& touch, Floating& floating, Transform& transform) {
        afloat.push_back({&touch, &floating, &transform});
    });
    if (afloat.empty()) {
        return;
    }
    waters.each([&](const Water& water, const WorldTransform& place, const OceanState* ocean,
                    const WaveTable* waves, RippleState* state) {
        surfaces.push_back({water_frame(place.world), water, ocean, waves, state});
        ripples.push_back(state);
    });
    parallel_for(afloat.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Body& body = afloat[i];
            body.splash = step_floating_body(
                surfaces, *body.touch, time->step, *body.floating, *body.transform);
        }
    });
    for (const Body& body : afloat) {  // in their order, whoever was the first to fall
        if (body.splash && ripples[body.splash->surface] != nullptr) {
            ripples[body.splash->surface]->impulses.push_back(body.splash->impulse);
        }
    }
}

}  // namespace limn
