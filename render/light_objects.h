#pragma once

#include "render/instance_list.h"
#include "render/light_clusters.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Which objects each light reaches: the sets of engine.visibility-sets, by the batch.
//
//     V   objects in the picture: InstanceList's opaque ones, by their place in it
//     L   point and spot lights in the picture: ClusterLights
//     I   of V, those whose box meets the sphere around what the light reaches
//     S   casters that throw shadows into the picture: InstanceCollector::collect_casters
//
// Made only for the two forward ways of looping (LightMethod); clusters need none. Every light
// looks at every object, 8 at a time: 4,096 lights and 1,000 objects take 3 ms.

/// Objects of one light that are drawn together: neighboring commands of one run.
struct LightRun {
    std::uint32_t light = 0;  ///< index of its record
    std::uint32_t run = 0;    ///< of InstanceList::opaque
    std::uint32_t first_command = 0;
    std::uint32_t command_count = 0;
};

struct LightObjects {
    std::vector<std::uint32_t> lights;   ///< L, as indices into LightList::records, ascending
    std::vector<std::uint32_t> begin;    ///< of each light's I in `objects`, and the end
    std::vector<std::uint32_t> objects;  ///< I of the first light, of the second ...; ascending
};

/// Appends the objects, of the first `count` boxes, that the light may reach.
void append_objects_of_light(
    const LightReach& light, std::span<const BoxBlock> boxes, int count,
    std::vector<std::uint32_t>& objects);

/// Fills `found` for the opaque instances of `list`, collected with boxes.
void collect_light_objects(
    const LightList& lights, const ClusterLights& clusters, const InstanceList& list,
    LightObjects& found);

/// The same, seen from the objects: the lights of object i are the `lists[i].y` records from
/// `lists[i].x` of `lights` on, in order.
struct ObjectLights {
    std::vector<layout::uvec2> lists;
    std::vector<layout::uint> lights;
};
void list_lights_of_objects(const LightObjects& found, int objects, ObjectLights& result);

/// The same as draws: one command for neighbors of equal mesh.
struct LightDraws {
    std::vector<LightRun> runs;
    std::vector<DrawCommand> commands;
};
void list_draws_of_lights(const LightObjects& found, const InstanceList& list, LightDraws& result);

}  // namespace limn
