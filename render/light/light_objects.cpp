#include "render/light/light_objects.h"

#include "render/shadow/light_bounds.h"

#include <algorithm>

// Techniques: engine.visibility-sets

namespace limn {
namespace {

/// Appends instance `place` of the draw `kind` to the light's commands.
void add_object(
    const DrawCommand& kind, std::uint32_t place, std::uint32_t light, std::uint32_t run,
    LightDraws& result) {
    if (result.runs.empty() || result.runs.back().light != light || result.runs.back().run != run) {
        result.runs.push_back({light, run, static_cast<std::uint32_t>(result.commands.size()), 0});
    }
    LightRun& draws = result.runs.back();
    DrawCommand* last = draws.command_count > 0 ? &result.commands.back() : nullptr;
    if (last != nullptr && last->base_instance >= kind.base_instance
        && last->base_instance + last->instance_count == place) {
        ++last->instance_count;
        return;
    }
    result.commands.push_back(kind);
    result.commands.back().base_instance = place;
    result.commands.back().instance_count = 1;
    ++draws.command_count;
}

}  // namespace

void append_objects_of_light(
    const LightRange& light, std::span<const BoxBlock> boxes, int count,
    std::vector<std::uint32_t>& objects) {
    const RangeSphere around = range_sphere(light);
    std::uint8_t touched[kCullBlock];
    for (int first = 0; first < count; first += kCullBlock) {
        const int n = std::min(count - first, kCullBlock);
        std::fill_n(touched, n, std::uint8_t{1});
        cull_boxes_by_distance(around.center, around.radius, boxes[first / kCullBlock], n, touched);
        for (int i = 0; i < n; ++i) {
            if (touched[i] != 0) {
                objects.push_back(static_cast<std::uint32_t>(first + i));
            }
        }
    }
}

void collect_light_objects(
    const LightList& lights, const ClusterLights& clusters, const InstanceList& list,
    LightObjects& found) {
    found.lights.clear();
    found.begin.assign(1, 0);
    found.objects.clear();
    for (const layout::ClusterLight& light : clusters.lights) {
        const auto record = static_cast<std::uint32_t>(light.axis.w);
        const std::uint32_t reach = record - static_cast<std::uint32_t>(lights.directional);
        append_objects_of_light(
            lights.reach[reach], list.boxes, list.opaque_instances, found.objects);
        found.lights.push_back(record);
        found.begin.push_back(static_cast<std::uint32_t>(found.objects.size()));
    }
}

void list_lights_of_objects(const LightObjects& found, int objects, ObjectLights& result) {
    // Count, sum, fill.
    result.lists.assign(static_cast<std::size_t>(objects), {0, 0});
    for (const std::uint32_t object : found.objects) {
        ++result.lists[object].y;
    }
    layout::uint total = 0;
    for (layout::uvec2& list : result.lists) {
        list.x = total;
        total += list.y;
        list.y = 0;
    }
    result.lights.resize(total);
    for (std::size_t i = 0; i < found.lights.size(); ++i) {
        for (std::uint32_t k = found.begin[i]; k < found.begin[i + 1]; ++k) {
            layout::uvec2& list = result.lists[found.objects[k]];
            result.lights[list.x + list.y++] = found.lights[i];
        }
    }
}

void list_draws_of_lights(const LightObjects& found, const InstanceList& list, LightDraws& result) {
    result.runs.clear();
    result.commands.clear();
    for (std::size_t i = 0; i < found.lights.size(); ++i) {
        // Objects and commands are both in instance order: one pass over both.
        std::uint32_t next = found.begin[i];
        const std::uint32_t end = found.begin[i + 1];
        for (std::uint32_t r = 0; r < list.opaque.size() && next < end; ++r) {
            const DrawRun& run = list.opaque[r];
            for (const DrawCommand& command :
                 list.command_values.subspan(run.first_command, run.command_count)) {
                const std::uint32_t past = command.base_instance + command.instance_count;
                for (; next < end && found.objects[next] < past; ++next) {
                    add_object(command, found.objects[next], found.lights[i], r, result);
                }
            }
        }
    }
}

}  // namespace limn
