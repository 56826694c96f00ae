#include "render/environment/env_probe_list.h"

#include "ecs/base/log.h"
#include "ecs/components/env_probe.h"
#include "ecs/world.h"
#include "render/environment/cube_map.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <vector>

// Techniques: env.capture

namespace limn {
namespace {

constexpr int kMinFace = 16;  ///< [px]

/// Unit axis `i` of a pose.
Vec3 probe_axis(const Affine& pose, int i) {
    Vec3 fallback(0);
    fallback[i] = 1;
    return normalize_or({pose.row[0][i], pose.row[1][i], pose.row[2][i]}, fallback);
}

/// The probe's region, as rows that map it to the unit sphere or cube.
void fill_region(const EnvProbe& probe, const Affine& pose, ProbeSlot& slot) {
    const Vec3 origin = {pose.row[0].w, pose.row[1].w, pose.row[2].w};
    const bool room = probe.box.x > 0 && probe.box.y > 0 && probe.box.z > 0;
    const Vec3 half = room ? probe.box : Vec3(std::max(probe.radius, 1e-3f));
    const Vec3 offset = room ? probe.box_center : Vec3(0);
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis = probe_axis(pose, i);
        slot.record.probe_from_world[i] = Vec4(axis, -glm::dot(axis, origin) - offset[i]) / half[i];
    }
    slot.record.shape = {room ? 1.0f : 0.0f, 1.0f / std::max(probe.fade, 1e-3f), 0, 0};
    slot.size = std::cbrt(half.x * half.y * half.z);
}

}  // namespace

void EnvProbeList::collect(const World& world, float alpha, int max_resolution) {
    for (ProbeSlot& slot : slots_) {
        slot.alive = false;
    }
    struct Found {
        Entity entity;
        const EnvProbe* probe;
        Affine pose;
        std::uint64_t due;
    };
    std::vector<Found> added;
    const auto update_slot = [&](ProbeSlot& slot, const Found& found) {
        const auto requested =
            static_cast<unsigned>(std::clamp(found.probe->resolution, kMinFace, max_resolution));
        const int resolution = static_cast<int>(std::bit_floor(requested));
        if (slot.entity != found.entity || slot.resolution != resolution) {
            gpu::Texture cube = std::move(slot.cube);
            slot = {
                .entity = found.entity,
                .resolution = resolution,
                .record = {},
                .cube = std::move(cube)};
        }
        slot.alive = true;
        // Six faces complete the cube, however many updates were missed.
        slot.due = found.due;
        const std::uint64_t first = found.due - std::min<std::uint64_t>(found.due, kCubeFaces);
        slot.drawn = slot.fresh == 0 ? first : std::max(slot.drawn, first);
        slot.near = std::max(found.probe->near, 1e-4f);
        if (slot.drawn < slot.due) {
            slot.capture_position = {found.pose.row[0].w, found.pose.row[1].w, found.pose.row[2].w};
        }
        fill_region(*found.probe, found.pose, slot);
    };
    const auto* const jumps = world.find_resource<StepJumps>();
    world
        .query<
            const EnvProbe, const WorldTransform, Optional<const PreviousWorldTransform>,
            Optional<const EnvProbeState>>()
        .each([&](Entity entity, const EnvProbe& probe, const WorldTransform& now,
                  const PreviousWorldTransform* before, const EnvProbeState* state) {
            const Affine pose = world_at(jumps, entity, now, before, {alpha, alpha});
            // Worlds that were never stepped have no states: every probe is captured once.
            const std::uint64_t due =
                std::max<std::uint64_t>(state != nullptr ? state->faces : 0, kCubeFaces);
            const Found found = {entity, &probe, pose, due};
            const auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const ProbeSlot& s) {
                return s.entity == entity;
            });
            if (slot != slots_.end()) {
                update_slot(*slot, found);
            } else {
                added.push_back(found);
            }
        });
    std::size_t served = 0;
    for (ProbeSlot& slot : slots_) {
        if (!slot.alive) {
            slot.entity = {};
            slot.ready = false;
            slot.fresh = 0;
            if (served < added.size()) {
                update_slot(slot, added[served++]);
            }
        }
    }
    if (served < added.size() && !reported_) {
        log_warn(
            "env_probe: {} probes found, expected at most {}; the rest are ignored",
            layout::kMaxProbes + added.size() - served, layout::kMaxProbes);
        reported_ = true;
    }
}

void EnvProbeList::forget() {
    for (ProbeSlot& slot : slots_) {
        slot.fresh = 0;
        slot.ready = false;
    }
}

layout::ProbeBlock EnvProbeList::make_block() const {
    std::array<std::size_t, layout::kMaxProbes> order{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (slots_[i].alive && slots_[i].ready) {
            order[count++] = i;
        }
    }
    std::stable_sort(order.begin(), order.begin() + count, [&](std::size_t a, std::size_t b) {
        return slots_[a].size < slots_[b].size;
    });
    layout::ProbeBlock block{};
    block.count.x = static_cast<float>(count);
    for (std::size_t i = 0; i < count; ++i) {
        const ProbeSlot& slot = slots_[order[i]];
        block.probes[i] = slot.record;
        block.probes[i].capture_position =
            Vec4(slot.capture_position, static_cast<float>(probe_layer(order[i])));
    }
    return block;
}

RenderView make_probe_view(const ProbeSlot& slot, int face, float alpha) {
    const Affine pose = cube_face_pose(face, slot.capture_position);
    RenderView view = make_render_view(
        {.fov_y = radians(90.0f), .near = slot.near}, pose, pose,
        {.width = slot.resolution, .height = slot.resolution});
    view.alpha = alpha;
    view.hidden = slot.entity;
    return view;
}

}  // namespace limn
