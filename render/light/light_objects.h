#pragma once

#include "render/geometry/instance_list.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/light_clusters.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

class ProjectorPool;

// Which objects each light reaches: the sets of engine.visibility-sets, evaluated in batches.
//
//     V   visible objects: InstanceList's opaque ones, by instance index
//     L   visible point and spot lights: ClusterLights
//     I   those of V whose box intersects the light's bounding sphere
//     S   casters of visible shadows: InstanceCollector::collect_casters
//
// Needed only by the two forward LightMethods, not by clusters. Every light is tested against every
// object, 8 at a time: 4,096 lights and 1,000 objects take 3 ms.

/// Objects of one light that are drawn together: consecutive commands of one run.
struct LightRun {
    std::uint32_t light = 0;  ///< index of its record
    std::uint32_t run = 0;    ///< index into InstanceList::opaque
    std::uint32_t first_command = 0;
    std::uint32_t command_count = 0;
};

struct LightObjects {
    std::vector<std::uint32_t> lights;  ///< L, as indices into LightList::records, ascending
    std::vector<std::uint32_t> begin;   ///< start of each light's I in `objects`, plus the end
    std::vector<std::uint32_t>
        objects;  ///< I of the first light, of the second ...; each ascending
};

/// Appends those of the first `count` boxes that the light may reach.
void append_objects_of_light(
    const LightRange& light, std::span<const BoxBlock> boxes, int count,
    std::vector<std::uint32_t>& objects);

/// Fills `found` for the opaque instances of `list`, which must have been collected with boxes.
void collect_light_objects(
    const LightList& lights, const ClusterLights& clusters, const InstanceList& list,
    LightObjects& found);

/// The inverse lists: the lights of object i are the `lists[i].y` records from `lists[i].x` on in
/// `lights`, in order.
struct ObjectLights {
    std::vector<layout::uvec2> lists;
    std::vector<layout::uint> lights;
};
void list_lights_of_objects(const LightObjects& found, int objects, ObjectLights& result);

/// The same as draws: one command for consecutive objects with equal mesh.
struct LightDraws {
    std::vector<LightRun> runs;
    std::vector<DrawCommand> commands;
};
void list_draws_of_lights(const LightObjects& found, const InstanceList& list, LightDraws& result);

/// The lights of a view as shaders read them, published once the view's lights have their shadows.
struct LightRecords {
    BufferTexture records = BufferTexture("lights", GL_RGBA32F);
    BufferTexture projectors = BufferTexture("projectors", GL_RGBA32F);
    const ProjectorPool* projector_pool = nullptr;
    LightObjects objects;  ///< of the forward methods
    ObjectLights object_lights;
    BufferTexture object_lists = BufferTexture("object lists", GL_RG32UI);
    BufferTexture object_indices = BufferTexture("object lights", GL_R32UI);
    LightDraws draws;  ///< of LightMethod::LightMajor
    gpu::RingSlice commands;
};

}  // namespace limn
