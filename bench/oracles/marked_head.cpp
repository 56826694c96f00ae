#include "bench/oracles/marked_head.h"

#include "ecs/world.h"
#include "systems/animation/surface_binding_system.h"

namespace limn::oracle {

SurfaceBindingState bind_to_markers(const MeshData& head, const MeshData& markers) {
    World world;
    world.insert_resource(Assets{}).meshes = {head, markers};
    SurfaceBinding binding;
    binding.surface = world.create(ControlSurface{MeshId{1}});
    binding.method = SurfaceMethod::Patches;
    binding.by_uvs = true;
    binding.reach = 0.1f;
    const Entity skin = world.create(MeshInstance{MeshId{0}, {}}, binding);
    world.run(add_surface_binding_states);
    world.run(bind_surfaces);
    return world.get<SurfaceBindingState>(skin);
}

}  // namespace limn::oracle
